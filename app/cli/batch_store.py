"""The folder of a batch: programs, the table, and what is known of each part, so that none is done twice."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..core.atomic import sweep, write_together
from ..core.digest import sha256
from ..core.errors import InputError
from ..core.file_lock import FileLock
from ..usecases.batch.table import Files
from ..usecases.batch.task import BatchResult, BatchRow, BatchVerdict

RECORDS = ".hitofude"
"""The folder of what is known, in the batch's own."""

Table = Callable[[Sequence[BatchRow], Files], Mapping[str, bytes]]
"""What is told of all parts, by their rows and files: bytes by the name of a file in the batch's folder."""


@dataclass(frozen=True)
class StoredPart:
    """What is known of a part.

    Attributes:
        key: of file, options and version that it was done with.
        row: of the table.
        files: SHA-256 of each of its files by its path from the folder.
    """

    key: str
    row: BatchRow
    files: Mapping[str, str]


class BatchStore:
    """A batch's folder, which one batch works on at a time."""

    def __init__(self, folder: Path) -> None:
        """Make the folder where there is none, keep others out, and take away what killed runs have left in it.

        Raises:
            InputError: it cannot be, or another batch works on it.
        """
        self.folder, self._records = folder, folder / RECORDS
        self._lock = FileLock(self._records / "lock")
        try:
            self._records.mkdir(parents=True, exist_ok=True)
            free = self._lock.take()
        except OSError as error:
            raise InputError(
                f"--output {folder}: it cannot be made: {error.strerror or error}; choose another"
            ) from error
        if not free:
            raise InputError(
                f"--output {folder}: another batch ({self._lock.owner()}) works on it; wait for its end, or choose "
                "another folder"
            )
        sweep(self._records, *{path.parent for path in folder.rglob("*.part")})

    def close(self) -> None:
        """Let other batches in."""
        self._lock.let_go()

    def known(self, output: str, key: str) -> BatchRow | None:
        """Return the row of a part that was done with this very input, if its files are still as they were written.

        Args:
            output: of its program, which tells parts apart.
        """
        stored = self._stored(output)
        if stored is None or stored.key != key or not stored.row.verdict.final:
            return None
        return stored.row if all(self._is(path, digest) for path, digest in stored.files.items()) else None

    def _is(self, path: str, digest: str) -> bool:
        try:
            return sha256((self.folder / path).read_bytes()) == digest
        except OSError:
            return False

    def files(self, output: str) -> tuple[str, ...]:
        """Return the files of a part, as paths from the folder."""
        stored = self._stored(output)
        return () if stored is None else tuple(stored.files)

    def keep(self, output: str, key: str, result: BatchResult) -> None:
        """Write the files of a part, and what is known of it, all or none; take away those of an earlier program of the
        part that it has no more, as far as nobody changed them.

        Raises:
            InputError: one cannot be written.
        """
        before = self._stored(output)
        digests = {path: sha256(data) for path, data in result.files.items()}
        told = {"key": key, "row": result.row.values(), "files": digests}
        files = {self.folder / path: data for path, data in result.files.items()}
        for target in files:
            self._make_parent(target)
        files[self._record(output)] = (json.dumps(told, indent=1) + "\n").encode()
        for path, digest in ({} if before is None else before.files).items():
            if path not in digests and self._is(path, digest):
                with suppress(OSError):
                    (self.folder / path).unlink()
        write_together(files)

    def _make_parent(self, path: Path) -> None:
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise InputError(f"Cannot write {path}: {error.strerror or error}.") from error

    def _record(self, output: str) -> Path:
        return self._records / f"{sha256(output.encode('utf-8', 'surrogatepass'))[:32]}.json"

    def _stored(self, output: str) -> StoredPart | None:
        """Return what is known of a part; what is damaged counts as not known."""
        try:
            told: dict[str, Any] = json.loads(self._record(output).read_bytes())
            return StoredPart(told["key"], BatchRow.of(told["row"]), dict(told["files"]))
        except (OSError, ValueError, KeyError, TypeError):
            return None

    def write_table(self, rows: Sequence[BatchRow], outputs: Sequence[str], table: Table) -> None:
        """Write the table of all parts.

        Args:
            rows: of the table. outputs: of each part's program. table: makes the files.

        Raises:
            InputError: it cannot be written.
        """
        files = [
            () if row.verdict is BatchVerdict.OPEN else self.files(output)
            for row, output in zip(rows, outputs, strict=True)
        ]
        write_together({self.folder / name: data for name, data in table(rows, files).items()})
