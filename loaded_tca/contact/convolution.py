"""Fast convolution of pressures with influence coefficients: planned, pruned transforms.

The only module that knows FFTW. Plans and their work arrays are kept per thread, since neither may be shared
while in use; what is kept is bounded by :data:`CACHE_BYTES`.
"""

import functools
import math
import multiprocessing
import os
import threading
from collections import OrderedDict, deque
from collections.abc import Callable, Hashable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np
import pyfftw
from scipy.fft import dctn

from loaded_tca.arrays import Array
from loaded_tca.contact.love import influence_coefficients

Window = tuple[slice, slice]
Piece = tuple[Any, ...]

CACHE_BYTES = 192 * 2**20
# Fewer points of a transform than this are not worth a second thread.
THREADED_POINTS = 2**17
# A piece of a transform, with its part of the kernel, should stay in the cache of a core.
PIECE_BYTES = 2**18
_forked = False


def _mark_fork() -> None:
    """Threads do not survive a fork: the child works with one, and plans anew."""
    global _forked, _cache
    _forked = True
    _cache = _Cache()


class _Cache(threading.local):
    """Least recently used plans and spectra of one thread, bounded in bytes."""

    def __init__(self) -> None:
        self.items: OrderedDict[Hashable, Any] = OrderedDict()
        self.pools: dict[int, ThreadPoolExecutor] = {}
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

    def pool(self, threads: int) -> ThreadPoolExecutor:
        """Helpers of this thread, made when first needed."""
        if threads not in self.pools:
            self.pools[threads] = ThreadPoolExecutor(threads - 1, thread_name_prefix="convolution")
        return self.pools[threads]


_cache = _Cache()
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_mark_fork)


@functools.cache
def fast_length(least: int) -> int:
    """Smallest even length 2^k (8, 9, 10, 12, 14, 15) not below ``least``: few, fast, at most 1/5 too long.

    Examples
    --------
    >>> [fast_length(n) for n in (1, 7, 9, 17, 33, 1000)]
    [2, 8, 10, 18, 36, 1024]
    """
    if least <= 8:
        return max(2, least + least % 2)
    power = 1 << (math.ceil(math.log2(least)) - 4)
    lengths = (power * m for m in (8, 9, 10, 12, 14, 15, 16))
    return next(length for length in lengths if length >= least and length % 2 == 0)


class _Transform:
    """Planned transforms of rows of real data in a periodic box, and back, in pieces that fit the cache.

    ``rows`` counts those that hold data on the way forth and on the way back: no others are transformed or kept. The
    doubled box itself exists in pieces only, one at a time in the work arrays of each thread.
    """

    def __init__(self, rows: tuple[int, int], box: tuple[int, int], dtype: str, threads: int) -> None:
        # The second direction first, so that transforms along the first run over contiguous data. Rows a power of two
        # apart share their place in the cache: a few unused columns keep them apart.
        shape = (box[1] // 2 + 1, (max(rows) + 15) // 8 * 8)
        kept = pyfftw.zeros_aligned(shape, dtype=np.result_type(dtype, np.complex64))
        self._forth, self._back = kept[:, : rows[0]], kept[:, : rows[1]]
        self._places = [_Workplace(self._forth, self._back, box, dtype) for _ in range(threads)]
        self.nbytes = kept.nbytes + sum(place.nbytes for place in self._places)

    def filter(self, values: Array, corner: tuple[int, int], symbol: Array, out: Array) -> None:
        """Transform values placed at a corner of the box, multiply by the symbol, transform back into ``out``.

        ``symbol`` is a quadrant of an even one, (second, first direction).
        """
        top, left = corner
        bottom, right = top + values.shape[0], left + values.shape[1]
        back = self._back.shape[1]
        middle = symbol.shape[1]

        def inward(part: slice, rows: Array, target: Array, plan: Any) -> None:
            if left:
                rows[:, :left] = 0.0
            rows[:, left:right] = values[part]
            rows[:, right:] = 0.0
            plan.update_arrays(rows, target)
            plan.execute()

        def across(part: slice, lines: Array, forth: Any, back_again: Any) -> None:
            if top:
                lines[:, :top] = 0.0
            lines[:, top:bottom] = self._forth[part]
            lines[:, bottom:] = 0.0
            forth.execute()
            lines[:, :middle] *= symbol[part]
            lines[:, middle:] *= symbol[part, middle - 2 : 0 : -1]
            back_again.execute()
            self._back[part] = lines[:, :back]

        def outward(part: slice, source: Array, rows: Array, plan: Any) -> None:
            plan.update_arrays(source, rows)
            plan.execute()
            np.copyto(out[part], rows[:, : out.shape[1]], casting="same_kind")

        _share(inward, [place.inward for place in self._places])
        _share(across, [place.across for place in self._places])
        _share(outward, [place.outward for place in self._places])


class _Workplace:
    """Work arrays of one thread, and for every piece its part of them and its plans."""

    def __init__(self, forth: Array, back: Array, box: tuple[int, int], dtype: str) -> None:
        high = _piece(max(forth.shape[1], back.shape[1]), box[1] * np.dtype(dtype).itemsize)
        wide = _piece(forth.shape[0], box[0] * forth.itemsize)
        rows = pyfftw.zeros_aligned((high, box[1]), dtype=dtype)
        lines = pyfftw.zeros_aligned((wide, box[0]), dtype=forth.dtype)
        self.nbytes = rows.nbytes + lines.nbytes
        plans: dict[tuple[str, int], Any] = {}

        def plan(source: Array, target: Array, name: str, direction: str) -> Any:
            """Plan of one-dimensional transforms along the second axis, one for all pieces of a size."""
            key = (name, source.shape[0])
            if key not in plans:
                plans[key] = pyfftw.FFTW(source, target, axes=(1,), direction=direction, flags=("FFTW_ESTIMATE",))
            return plans[key]

        self.inward: list[Piece] = []
        self.across: list[Piece] = []
        self.outward: list[Piece] = []
        for part, count in _pieces(forth.shape[1], high):
            own, target = rows[:count], forth.T[part]
            self.inward.append((part, own, target, plan(own, target, "inward", "FFTW_FORWARD")))
        for part, count in _pieces(forth.shape[0], wide):
            own = lines[:count]
            there, again = (plan(own, own, way, way) for way in ("FFTW_FORWARD", "FFTW_BACKWARD"))
            self.across.append((part, own, there, again))
        for part, count in _pieces(back.shape[1], high):
            own, source = rows[:count], back.T[part]
            self.outward.append((part, source, own, plan(source, own, "outward", "FFTW_BACKWARD")))


def _piece(count: int, row_bytes: int) -> int:
    """Rows of a piece of about :data:`PIECE_BYTES`, a multiple of 8 (aligned data), of ``count`` in all."""
    return min(count, max(8, PIECE_BYTES // row_bytes // 8 * 8))


def _pieces(count: int, size: int) -> list[tuple[slice, int]]:
    """Rows in pieces of a size, and the rows of each."""
    return [(slice(start, min(start + size, count)), min(size, count - start)) for start in range(0, count, size)]


def _share(work: Callable[..., None], places: list[list[Piece]]) -> None:
    """Do the work on every piece; helpers take pieces too, and nobody waits for a helper that has not begun."""
    count = len(places[0])
    if len(places) == 1 or count == 1:
        for piece in places[0]:
            work(*piece)
        return
    waiting = deque(range(count))

    def drain(own: list[Piece]) -> None:
        while True:
            try:
                index = waiting.popleft()
            except IndexError:
                return
            work(*own[index])

    helpers = [_cache.pool(len(places)).submit(drain, own) for own in places[1:count]]
    drain(places[0])
    for helper in helpers:
        if not helper.cancel():
            helper.result()


class Convolution:
    """Displacement of ``target`` cells under the pressure on a window of them, in dx/E* and E*.

    Parameters
    ----------
    target : (int, int)
        Shape of the grid.
    aspect : float
        dy/dx.
    window : (slice, slice), optional
        Where the pressure is; the whole grid if absent.
    dtype : {"float64", "float32"}
        Precision of the transforms.
    threads : int
        Threads of one transform.
    """

    def __init__(
        self,
        target: tuple[int, int],
        aspect: float,
        window: Window | None = None,
        dtype: str = "float64",
        threads: int = 2,
    ) -> None:
        first, last = (0, 0), target
        if window is not None:
            first, last = (window[0].start, window[1].start), (window[0].stop, window[1].stop)
        # The kernel is even: it may wrap once the box is twice the greatest distance of two cells.
        reach = [max(end, n - start) - 1 for start, end, n in zip(first, last, target, strict=True)]
        box = (fast_length(max(2 * reach[0], target[0])), fast_length(max(2 * reach[1], target[1])))
        threads = useful_threads(box, threads)
        rows = (last[0] - first[0], target[0])
        self.target = target
        self.corner = first
        self.count = 0
        self._symbol = _cache.get(("love", box, aspect, dtype), lambda: _kernel(box, aspect, dtype))
        self._transform = _cache.get((rows, box, dtype, threads), lambda: _Transform(rows, box, dtype, threads))

    def __call__(self, pressure: Array, out: Array) -> Array:
        """Write the displacement into ``out`` and return it."""
        self.count += 1
        self._transform.filter(pressure, self.corner, self._symbol.values, out)
        return out


class Preconditioner:
    """Approximate inverse of the convolution: that of the periodic kernel, in single precision."""

    def __init__(self, shape: tuple[int, int], aspect: float, threads: int = 2) -> None:
        box = (fast_length(shape[0]), fast_length(shape[1]))
        threads = useful_threads(box, threads)
        rows = (shape[0], shape[0])
        self.shape = shape
        self._symbol = _cache.get(("inverse", box, aspect), lambda: _Symbol(_inverse_symbol(box, aspect), "float32"))
        self._transform = _cache.get((rows, box, "float32", threads), lambda: _Transform(rows, box, "float32", threads))

    def __call__(self, residual: Array, out: Array) -> Array:
        """Write the preconditioned residual into ``out`` and return it."""
        self._transform.filter(residual, (0, 0), self._symbol.values, out)
        return out


class _Symbol:
    """A quadrant of the real, even transform of a kernel, as the spectrum is laid out."""

    def __init__(self, quadrant: Array, dtype: str) -> None:
        self.values = np.ascontiguousarray(quadrant.T, dtype=dtype)
        self.nbytes = self.values.nbytes


def useful_threads(box: tuple[int, int], wanted: int) -> int:
    """One for small transforms, and in workers: threads do not survive a fork, and a pool fills the machine."""
    worker = _forked or multiprocessing.parent_process() is not None
    return 1 if worker or box[0] * box[1] < THREADED_POINTS else min(wanted, os.cpu_count() or 1)


def _kernel(box: tuple[int, int], aspect: float, dtype: str) -> _Symbol:
    """Return Love's kernel in a box; in single precision the kept one rounded."""
    if dtype == "float64":
        return _Symbol(_love_symbol(box, aspect), dtype)
    exact = _cache.get(("love", box, aspect, "float64"), lambda: _kernel(box, aspect, "float64"))
    return _Symbol(exact.values.T, dtype)


def _love_symbol(box: tuple[int, int], aspect: float) -> Array:
    """Transform of Love's coefficients wrapped into the box, over the number of points of the box."""
    quadrant = influence_coefficients((box[0] // 2 + 1, box[1] // 2 + 1), aspect)
    symbol = dctn(quadrant, type=1, overwrite_x=True)
    symbol /= box[0] * box[1]
    return np.asarray(symbol)


def _inverse_symbol(box: tuple[int, int], aspect: float) -> Array:
    """Reciprocal of the transform of the wrapped coefficients, over the number of points of the box."""
    transformed = _love_symbol(box, aspect) * (box[0] * box[1])
    floor = transformed.max() * np.finfo(np.float32).eps
    return np.asarray(1.0 / (np.maximum(transformed, floor) * (box[0] * box[1])))
