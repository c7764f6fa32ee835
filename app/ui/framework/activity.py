"""What runs in the background: one place for how far it is, for leaving it, and for its end with the window."""

from __future__ import annotations

from PySide6.QtCore import QObject, Signal

from .worker import Worker


class Activity(QObject):
    """Follows workers for whoever shows that something is computed.

    Signals:
        progress(fraction or None, text): of whoever told last, in [0, 1]; None = nothing runs any more.
        remarked(text): what its user should hear before the work is done, such as that it takes long.
        busy_changed(bool): something runs, or nothing. cancelled(): the user leaves what runs.
        ended(): the window has closed; whoever holds threads or much memory lets go of them.
    """

    progress = Signal(object, str)
    remarked = Signal(str)
    busy_changed = Signal(bool)
    cancelled = Signal()
    ended = Signal()

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._workers: list[Worker] = []

    @property
    def busy(self) -> bool:
        """Whether a worker that is followed runs a job."""
        return any(worker.busy for worker in self._workers)

    def follow(self, worker: Worker, text: str = "") -> None:
        """Show a worker's progress, let it be cancelled, and have it end with the window.

        Args:
            worker: to follow. text: what is said until the job says something itself.
        """
        self._workers.append(worker)
        worker.progress.connect(self._tell)
        worker.remarked.connect(self.remarked)
        worker.busy_changed.connect(lambda busy: self._on_busy(text if busy else ""))
        self.cancelled.connect(worker.cancel)
        self.ended.connect(worker.finish)

    def cancel(self) -> bool:
        """Leave what runs; return whether anything did."""
        busy = self.busy
        self.cancelled.emit()
        return busy

    def _tell(self, fraction: float, text: str) -> None:
        self.progress.emit(fraction, text)

    def _on_busy(self, text: str) -> None:
        busy = self.busy
        self.progress.emit(0.0 if busy else None, text)
        self.busy_changed.emit(busy)
