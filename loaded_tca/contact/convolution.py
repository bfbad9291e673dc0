"""Fast convolution of pressures with influence coefficients: planned, pruned transforms.

The only module that knows FFTW. Plans and their work arrays are kept per thread, since neither may be shared
while in use; what is kept is bounded by :data:`CACHE_BYTES`.
"""

import math
import multiprocessing
import os
import threading
from collections import OrderedDict
from collections.abc import Callable, Hashable
from typing import Any

import numpy as np
import pyfftw
from numpy.typing import NDArray
from scipy.fft import dctn

from loaded_tca.contact.love import influence_coefficients

Array = NDArray[Any]
Window = tuple[slice, slice]

CACHE_BYTES = 192 * 2**20
# Two threads pay from about this many points of a transform; where the other core is busy they cost more than
# they bring, so that small transforms, and those of workers, keep to one.
THREADED_POINTS = 2**19
_forked = False


def _mark_fork() -> None:
    """FFTW's threads do not survive a fork: the child works with one, and plans anew."""
    global _forked, _cache
    _forked = True
    _cache = _Cache()


class _Cache(threading.local):
    """Least recently used plans and spectra of one thread, bounded in bytes."""

    def __init__(self) -> None:
        self.items: OrderedDict[Hashable, Any] = OrderedDict()
        self.bytes = 0

    def get(self, key: Hashable, make: Callable[[], Any]) -> Any:
        """Return what is kept under the key; make and keep it otherwise."""
        if key in self.items:
            self.items.move_to_end(key)
            return self.items[key]
        made = make()
        self.items[key] = made
        self.bytes += made.nbytes
        while self.bytes > CACHE_BYTES and len(self.items) > 1:
            self.bytes -= self.items.popitem(last=False)[1].nbytes
        return made


_cache = _Cache()
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_mark_fork)


def default_threads() -> int:
    """Threads of a large transform: two where there are two cores and this process is no worker of a pool."""
    if _forked or multiprocessing.parent_process() is not None:
        return 1
    return min(2, os.cpu_count() or 1)


def fast_length(least: int) -> int:
    """Smallest even length 2^k (8, 9, 10, 12, 14) not below ``least``: few, fast, at most 1/5 too long.

    Examples
    --------
    >>> [fast_length(n) for n in (1, 7, 9, 17, 33, 1000)]
    [2, 8, 10, 18, 36, 1024]
    """
    if least <= 8:
        return max(2, least + least % 2)
    power = 1 << (math.ceil(math.log2(least)) - 4)
    lengths = (power * m for m in (8, 9, 10, 12, 14, 16))
    return next(length for length in lengths if length >= least and length % 2 == 0)


class _Transform:
    """Planned transforms of rows of real data in a periodic box, and back.

    ``spectrum`` holds the transform of the box with the second direction first, so that every one-dimensional
    transform runs over contiguous data; rows without data are never transformed. ``rows`` counts those that
    hold data on the way forth and on the way back.
    """

    def __init__(self, rows: tuple[int, int], box: tuple[int, int], dtype: str, threads: int) -> None:
        complex_type = "complex64" if dtype == "float32" else "complex128"
        self.data = pyfftw.zeros_aligned((rows[0], box[1]), dtype=dtype)
        self.result: Array = pyfftw.zeros_aligned((rows[1], box[1]), dtype=dtype)
        # Rows a power of two apart share their place in the cache: a few unused columns keep them apart.
        padded = pyfftw.zeros_aligned((box[1] // 2 + 1, box[0] + 8), dtype=complex_type)
        self.spectrum = padded[:, : box[0]]
        by_rows = self.spectrum.T
        plan: dict[str, Any] = {"axes": (1,), "flags": ("FFTW_ESTIMATE",), "threads": threads}
        self.rows_forward = pyfftw.FFTW(self.data, by_rows[: rows[0]], **plan)
        self.forward = pyfftw.FFTW(self.spectrum, self.spectrum, **plan)
        plan["direction"] = "FFTW_BACKWARD"
        self.backward = pyfftw.FFTW(self.spectrum, self.spectrum, **plan)
        self.rows_backward = pyfftw.FFTW(by_rows[: rows[1]], self.result, **plan)
        self.nbytes = self.data.nbytes + self.result.nbytes + self.spectrum.nbytes

    def filter(self, values: Array, corner: tuple[int, int], symbol: Array) -> Array:
        """Transform values placed at a corner of the box, multiply by the symbol, transform back."""
        (top, left), (rows, columns) = corner, values.shape
        self.data[:, :left] = 0.0
        self.data[:, left : left + columns] = values
        self.data[:, left + columns :] = 0.0
        self.rows_forward.update_arrays(self.data, self.spectrum.T[top : top + rows])
        self.rows_forward.execute()
        self.spectrum[:, :top] = 0.0
        self.spectrum[:, top + rows :] = 0.0
        self.forward.execute()
        self.spectrum *= symbol
        self.backward.execute()
        self.rows_backward.execute()
        return self.result


class Convolution:
    """Displacement of ``target`` cells under the pressure on a window of them, in dx/E* and E*.

    Parameters
    ----------
    target : (int, int)
        Shape of the grid.
    aspect : float
        dy/dx.
    window : (slice, slice), optional
        Where the pressure is; the whole grid if absent. Its first row has to be a multiple of 4 (FFTW asks for
        aligned data).
    dtype : {"float64", "float32"}
        Precision of the transforms.
    threads : int, optional
        Threads of one transform; default: two for large ones.
    """

    def __init__(
        self,
        target: tuple[int, int],
        aspect: float,
        window: Window | None = None,
        dtype: str = "float64",
        threads: int | None = None,
    ) -> None:
        first, last = (0, 0), target
        if window is not None:
            first, last = (window[0].start, window[1].start), (window[0].stop, window[1].stop)
        # The kernel is even: it may wrap once the box is twice the greatest distance of two cells.
        reach = [max(end, n - start) - 1 for start, end, n in zip(first, last, target, strict=True)]
        box = (fast_length(max(2 * reach[0], target[0])), fast_length(max(2 * reach[1], target[1])))
        threads = _threads(box, threads)
        rows = (last[0] - first[0], target[0])
        self.target = target
        self.corner = first
        self.count = 0
        self._symbol = _cache.get(("love", box, aspect, dtype), lambda: _Symbol(_love_symbol(box, aspect), dtype))
        self._transform = _cache.get((rows, box, dtype, threads), lambda: _Transform(rows, box, dtype, threads))

    def __call__(self, pressure: Array, out: Array) -> Array:
        """Write the displacement into ``out`` and return it."""
        self.count += 1
        result = self._transform.filter(pressure, self.corner, self._symbol.values)
        np.copyto(out, result[:, : self.target[1]], casting="same_kind")
        return out


class Preconditioner:
    """Approximate inverse of the convolution: that of the periodic kernel, in single precision."""

    def __init__(self, shape: tuple[int, int], aspect: float, threads: int | None = None) -> None:
        box = (fast_length(shape[0]), fast_length(shape[1]))
        threads = _threads(box, threads)
        rows = (shape[0], shape[0])
        self.shape = shape
        self._symbol = _cache.get(("inverse", box, aspect), lambda: _Symbol(_inverse_symbol(box, aspect), "float32"))
        self._transform = _cache.get((rows, box, "float32", threads), lambda: _Transform(rows, box, "float32", threads))

    def __call__(self, residual: Array, out: Array) -> Array:
        """Write the preconditioned residual into ``out`` and return it."""
        result = self._transform.filter(residual, (0, 0), self._symbol.values)
        np.copyto(out, result[:, : self.shape[1]], casting="same_kind")
        return out


class _Symbol:
    """Real even transform of a kernel, from a quadrant of it, as the spectrum is laid out."""

    def __init__(self, quadrant: Array, dtype: str) -> None:
        half = quadrant.T[:, : quadrant.shape[0] - 1].astype(dtype)
        mirrored = quadrant.T[:, :0:-1].astype(dtype)
        self.values = np.concatenate((half, mirrored), axis=1)
        self.nbytes = self.values.nbytes


def _threads(box: tuple[int, int], wanted: int | None) -> int:
    if wanted is not None:
        return wanted
    return default_threads() if box[0] * box[1] >= THREADED_POINTS else 1


def _love_symbol(box: tuple[int, int], aspect: float) -> Array:
    """Transform of Love's coefficients wrapped into the box, over the number of points of the box."""
    quadrant = influence_coefficients((box[0] // 2 + 1, box[1] // 2 + 1), aspect)
    return np.asarray(dctn(quadrant, type=1) / (box[0] * box[1]))


def _inverse_symbol(box: tuple[int, int], aspect: float) -> Array:
    """Reciprocal of the transform of the wrapped coefficients, over the number of points of the box."""
    transformed = _love_symbol(box, aspect) * (box[0] * box[1])
    floor = transformed.max() * np.finfo(np.float32).eps
    return np.asarray(1.0 / (np.maximum(transformed, floor) * (box[0] * box[1])))
