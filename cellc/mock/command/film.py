"""`cellc mock --film FILE`: a film of one rehearsal, as GIF, or as MP4 where the program `ffmpeg` is installed."""

from __future__ import annotations

import io
import shutil
import subprocess
from collections.abc import Iterator, Sequence
from pathlib import Path
from time import process_time

import numpy as np
from PIL import Image, ImageDraw

from cellc.contract.errors import reason_of
from cellc.contract.limits import Budget, BudgetError, limits, option
from cellc.contract.printing import progress
from cellc.contract.store.swap import replace_whole
from cellc.mock.cell import MockCell
from cellc.mock.errors import MockError
from cellc.mock.evidence.images.film import RATE_HZ, SIZE, Film, Moment
from cellc.mock.result import RehearsalResult

SUFFIXES = (".gif", ".mp4")
_COLORS = 128
_LOOKED_AT = 8
"""Pictures that the colors of a GIF are taken from."""
_INK = (40, 44, 52)
_MP4 = ("-loglevel", "error", "-an", "-c:v", "libx264", "-pix_fmt", "yuv420p", "-movflags", "frag_keyframe+empty_moov")


def encoder(path: Path) -> str:
    """Return the program that encodes a film; empty where none is needed.

    Raises:
        MockError: the suffix is not one of a film, or the program is not installed.
    """
    if path.suffix.lower() not in SUFFIXES:
        raise MockError(path.as_posix(), f"must end with {' or '.join(SUFFIXES)}, got `{path.suffix or path.name}`")
    if path.suffix.lower() == ".gif":
        return ""
    program = shutil.which("ffmpeg")
    if program is None:
        raise MockError(
            path.as_posix(), "needs the program `ffmpeg`, which is not installed; name a file that ends with .gif"
        )
    return program


def filmed(cell: MockCell, name: str, seed: int, path: Path) -> RehearsalResult:
    """Run a rehearsal and write its film.

    Raises:
        MockError: it names what the contract does not have, or the film cannot be made or written.
    """
    program, films = encoder(path), list[Film]()
    folder = cell.folder
    result = cell.rehearse(
        cell.entry(name),
        seed=seed,
        watch=lambda plant: films.append(Film(plant, folder.description, folder.mesh_roots)),
    )
    moments = films[-1].moments(result.attempts[0].started_ns) if films and result.attempts else ()
    if not moments:
        raise MockError(path.as_posix(), f"is not written: nothing of `{name}` ran ({result.outcome})")
    try:
        pictures = Budget(limits().rehearsal_seconds, process_time).over(_pictures(films[-1], moments, result))
        replace_whole(path, _mp4(program, pictures, path) if program else _gif(pictures, len(moments)))
    except BudgetError:
        most = f"drawing must take at most {limits().rehearsal_seconds} s of processor time"
        raise MockError(path.as_posix(), f"{most}; {option('rehearsal-seconds')}") from None
    except OSError as error:
        raise MockError(path.as_posix(), f"cannot be written: {reason_of(error)}") from None
    return result


def _pictures(film: Film, moments: Sequence[Moment], result: RehearsalResult) -> Iterator[Image.Image]:
    """Yield the pictures, each with the rehearsal, the time since it began, and its step."""
    start_ns = moments[0].stamp_ns
    with progress("film") as update:
        for number, (moment, frame) in enumerate(zip(moments, film.frames(moments), strict=True), start=1):
            update(f"picture {number} of {len(moments)}")
            picture = Image.fromarray(frame)
            begun = [each.step for each in result.attempts[:-1] if each.started_ns <= moment.stamp_ns]
            words = f"{result.title}   {(moment.stamp_ns - start_ns) / 1e9:.1f} s   {begun[-1] if begun else ''}"
            ImageDraw.Draw(picture).text((8, 6), words, fill=_INK)
            yield picture


def _gif(pictures: Iterator[Image.Image], count: int) -> bytes:
    """Return a GIF with one table of colors, so that nothing flickers."""
    drawn = list(pictures)
    some = drawn[:: max(1, count // _LOOKED_AT)]
    table = Image.fromarray(np.concatenate([np.asarray(picture) for picture in some])).quantize(_COLORS)
    first, *rest = (picture.quantize(palette=table, dither=Image.Dither.NONE) for picture in drawn)
    file = io.BytesIO()
    first.save(file, "GIF", save_all=True, append_images=rest, duration=1000 // RATE_HZ, loop=0)
    return file.getvalue()


def _mp4(program: str, pictures: Iterator[Image.Image], path: Path) -> bytes:
    """Return what the encoder makes of the pictures.

    Raises:
        MockError: it fails.
        OSError: it cannot be started.
    """
    size, raw = f"{SIZE[0]}x{SIZE[1]}", b"".join(picture.tobytes() for picture in pictures)
    given = ("-f", "rawvideo", "-pix_fmt", "rgb24", "-s", size, "-r", str(RATE_HZ), "-i", "-")
    made = subprocess.run((program, *given, *_MP4, "-f", "mp4", "-"), input=raw, capture_output=True, check=False)
    if made.returncode or not made.stdout:
        lines = made.stderr.decode(errors="replace").split("\n")
        raise MockError(path.as_posix(), f"is not written: ffmpeg ended with {made.returncode}: {lines[0].strip()}")
    return made.stdout
