"""Whose work is inside: the packages that this installation runs with, and their licences, as they say themselves."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from importlib.metadata import Distribution, PackageNotFoundError, distribution

OWN = "hitofude"
_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]*")
_LONG = 60
"""Letters beyond which a licence's field holds its text rather than its name."""


@dataclass(frozen=True)
class PackageLicence:
    """A package that is installed.

    Attributes:
        name, version: its own.
        licence: its name; "not stated" where it says none.
        home: address of its page; "" = none.
        files: texts of its licences, by the names of their files.
    """

    name: str
    version: str
    licence: str
    home: str
    files: dict[str, str]


def installed_licences() -> tuple[PackageLicence, ...]:
    """Return this program and every package that it needs, as far as they are installed, by their names."""
    found: dict[str, Distribution] = {}
    waiting = [OWN]
    while waiting:
        name = _plain(waiting.pop())
        if name in found:
            continue
        try:
            package = distribution(name)
        except PackageNotFoundError:
            continue
        found[name] = package
        waiting += list(_needed(package))
    return tuple(_licence_of(found[name]) for name in sorted(found, key=lambda name: (name != OWN, name)))


def _plain(name: str) -> str:
    return re.sub(r"[-_.]+", "-", name).lower()


def _needed(package: Distribution) -> Iterator[str]:
    """Yield the names of packages that one cannot do without; what is only an extra's is not."""
    for requirement in package.requires or ():
        match = _NAME.match(requirement)
        if match is not None and "extra ==" not in requirement.replace('"', "'"):
            yield match[0]


def _licence_of(package: Distribution) -> PackageLicence:
    about = package.metadata
    addresses = [value.partition(",")[2].strip() for value in about.get_all("Project-URL") or ()]
    home = _field(package, "Home-page") or next(iter(addresses), "")
    return PackageLicence(about["Name"], package.version, _name_of(package), home, dict(_texts(package)))


def _name_of(package: Distribution) -> str:
    about = package.metadata
    short = _field(package, "License-Expression") or _field(package, "License")
    if short and len(short) <= _LONG and "\n" not in short and short.upper() != "UNKNOWN":
        return short
    classifiers = [
        each.rpartition(" :: ")[2] for each in about.get_all("Classifier") or () if each.startswith("License :: ")
    ]
    told = [each for each in classifiers if each != "OSI Approved"]
    return ", ".join(told) or short.strip().partition("\n")[0][:_LONG] or "not stated"


def _field(package: Distribution, name: str) -> str:
    """Return a field; "" where there is none."""
    return next(iter(package.metadata.get_all(name) or ()), "")


def _texts(package: Distribution) -> Iterator[tuple[str, str]]:
    for file in package.files or ():
        if ".dist-info" in str(file) and re.search(r"licen[cs]e|copying|notice", file.name, re.IGNORECASE):
            path = package.locate_file(file)
            try:
                with open(str(path), encoding="utf-8", errors="replace") as text:
                    yield file.name, text.read()
            except OSError:
                continue
