"""Reads files as the programs do: what is no file is refused, what changed is told, and a failure of the machine is no damaged file."""
from __future__ import annotations

import contextlib
import ctypes
import errno
import functools
import os
import stat
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import IO, Any

from ._program import ClearwayError, EnvironmentFault, InputError

#: By these the machine fails, not the code; as core::is_of_machine.
REASONS_OF_MACHINE = {errno.EIO, errno.EMFILE, errno.ENFILE, errno.ENOMEM, errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.ESTALE}
NO_MEMORY = os.strerror(errno.ENOMEM)
#: Another path or other permissions help; as core::fail_to_read.
_REASONS_OF_PATH = {errno.ENOENT, errno.ENOTDIR, errno.EISDIR, errno.EACCES, errno.EPERM, errno.ELOOP, errno.ENAMETOOLONG, errno.ENXIO}
CURE = "Check that it exists and is readable"


def is_of_machine(error: BaseException | None) -> bool:
    """Also when the code caught what the machine did and raised something else, and in words, as torch tells it."""
    seen: set[int] = set()  # code may chain errors in a circle
    while error is not None and id(error) not in seen:
        seen.add(id(error))
        if isinstance(error, MemoryError) or (isinstance(error, OSError) and error.errno in REASONS_OF_MACHINE):
            return True
        if isinstance(error, RuntimeError) and any(NO_MEMORY in word for word in error.args if isinstance(word, str)):
            return True
        error = error.__cause__ or (None if error.__suppress_context__ else error.__context__)
    return False


def refusal(place: Any, reason: int | None, cure: str = CURE) -> ClearwayError:
    """Why a file or folder could not be read, by its ``errno``: InputError with the cure where the path is wrong."""
    reason = reason or errno.EIO
    said = f"{place}: cannot be read: {os.strerror(reason)}"
    if reason in _REASONS_OF_PATH:
        return InputError(f"{said}. {cure}")
    fault = EnvironmentFault(f"{said}. The machine failed, not the file's content: give the same call again")
    fault.errno = reason
    return fault


def path_of(what: str, value: Any) -> Path:
    if not isinstance(value, (str, os.PathLike)) or "\0" in str(value):
        shown = repr(value)
        shown = f"a {type(value).__name__}" if "\n" in shown else shown
        raise InputError(f"{what} is {shown} (allowed: a path without the character U+0000, or results or a recording, which have one)")
    return Path(value)


def _without_waiting(file: str, flags: int) -> int:
    return os.open(file, flags | os.O_NONBLOCK)  # a pipe waits for who writes


@contextlib.contextmanager
def reading(file: Path, cure: str = CURE) -> Iterator[IO[bytes]]:
    """The file, open; the block only reads it. Raises InputError for what is no file, and what ``refusal`` tells."""
    try:
        with open(file, "rb", opener=_without_waiting) as stream:
            if not stat.S_ISREG(os.fstat(stream.fileno()).st_mode):
                raise InputError(f"{file}: is not a regular file (allowed: a file; a pipe or a device may have no end). Remove it, or put a copy of "
                                 "what it stands for in its place")
            yield stream
    except ClearwayError:
        raise
    except OSError as error:
        raise refusal(file, error.errno, cure) from None


def content(file: Path, cure: str = CURE) -> bytes:
    with reading(file, cure) as stream:
        return stream.read()


def listed(folder: Path) -> list[Path]:
    """What is in a folder, sorted; nothing where it is none."""
    try:
        return sorted(folder.iterdir())
    except (FileNotFoundError, NotADirectoryError):
        return []
    except OSError as error:
        raise refusal(folder, error.errno) from None


def below(folder: Path, endings: tuple[str, ...]) -> list[Path]:
    """What is in ``folder`` and the folders in it by the ends of names, sorted. Links to folders are not followed."""
    def fail(error: OSError) -> None:
        raise refusal(error.filename or folder, error.errno) from None
    return sorted(Path(place, name) for place, folders, files in os.walk(folder, onerror=fail) for name in (*folders, *files)
                  if name.endswith(endings))


class _Digest(ctypes.Structure):
    _fields_ = [("low64", ctypes.c_uint64), ("high64", ctypes.c_uint64)]


@functools.cache
def _xxhash() -> ctypes.CDLL:
    """The library of the hash: Python has none of this kind, and its own loop would take a second per megabyte."""
    try:
        library = ctypes.CDLL("libxxhash.so.0")
    except OSError as error:
        raise EnvironmentFault(f"libxxhash cannot be loaded (Debian: libxxhash0): {error}. Without it, a file that was changed or damaged "
                               "would be taken for whole") from None
    library.XXH3_createState.restype = ctypes.c_void_p
    library.XXH3_128bits_digest.restype = _Digest
    for call in (library.XXH3_128bits_reset, library.XXH3_128bits_digest, library.XXH3_freeState):
        call.argtypes = [ctypes.c_void_p]
    library.XXH3_128bits_update.argtypes = [ctypes.c_void_p, ctypes.c_char_p, ctypes.c_size_t]
    return library


def content_hash(pieces: Iterable[bytes]) -> str:
    """The hash of them in a row, by which files are sealed; as core::content_hash."""
    library = _xxhash()
    state = library.XXH3_createState()
    if not state:
        raise MemoryError
    try:
        library.XXH3_128bits_reset(state)
        for piece in pieces:
            library.XXH3_128bits_update(state, piece, len(piece))
        digest = library.XXH3_128bits_digest(state)
    finally:
        library.XXH3_freeState(state)
    return f"{digest.high64:016x}{digest.low64:016x}"
