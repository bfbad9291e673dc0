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
from collections.abc import Callable, Hashable, Sequence
from concurrent.futures import ThreadPoolExecutor
from copy import copy
from dataclasses import dataclass, field
from typing import Any, Self

import numpy as np
import pyfftw
from numpy.typing import ArrayLike
from scipy.fft import dctn

from loaded_tca.arrays import Array, Indices
from loaded_tca.contact.love import influence_coefficients

Window = tuple[slice, slice]

CACHE_BYTES = 192 * 2**20
# Fewer points of a transform than this are not worth a second thread.
THREADED_POINTS = 2**17
# A piece of a transform, with its part of the kernel, should stay in the cache of a core.
PIECE_BYTES = 2**18
# So should the work arrays of the small problems that are transformed together; more problems than this save nothing.
BLOCK_BYTES = 2**18
LARGEST_BLOCK = 16
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

    def get(self, key: Hashable, make: Callable[[], Any] | None = None) -> Any:
        """Return what is kept under the key; otherwise make and keep it, or None if nothing is given to make it."""
        if key in self.items:
            self.items.move_to_end(key)
            return self.items[key]
        if make is None:
            return None
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
    """Planned transforms of rows of real data in a periodic box, and back, of several problems or in pieces.

    ``rows`` counts those that hold data on the way forth and on the way back: no others are transformed or kept. What
    is worked on at a time fits the cache: a block of small problems at once, or a piece of a large one after the other.
    The doubled box of a large one itself exists in pieces only, one at a time in the work arrays of each thread: that
    takes 14 % off a solve on 512 x 512 cells and 20 % off one on 1024 x 1024, and threads need not wait for each other
    within a piece. Every problem of a block has plans of its own, all alike, so that its result is the same to the last
    bit wherever it stands and whatever stands beside it.
    """

    def __init__(self, rows: tuple[int, int], box: tuple[int, int], dtype: str, threads: int) -> None:
        # The second direction first, so that transforms along the first run over contiguous data. Rows a power of two
        # apart share their place in the cache: a few unused ones keep them apart.
        compound = np.result_type(dtype, np.complex64)
        row_bytes, line_bytes = box[1] * np.dtype(dtype).itemsize, box[0] * compound.itemsize
        inward, outward = (_pieces(count, row_bytes, 8) for count in rows)  # whole eights of rows are aligned
        across = _pieces(box[1] // 2 + 1, line_bytes)
        room = (max(inward[-1].stop, outward[-1].stop) + 15) // 8 * 8
        self._parts = inward, across, outward
        self._rows, self._box, self._dtype, self._compound = rows, box, dtype, compound
        each = (inward[0].stop + outward[0].stop) * row_bytes + across[0].stop * (line_bytes + room * compound.itemsize)
        self._whole = len(inward) == len(across) == len(outward) == 1
        self.block = min(LARGEST_BLOCK, max(1, BLOCK_BYTES // each)) if self._whole else 1
        self._kept = _aligned((self.block, across[-1].stop, room), compound)
        self._spectrum = self._kept[:, : box[1] // 2 + 1].transpose(0, 2, 1)
        self._works = [self._work() for _ in range(threads)]
        self.nbytes = self._kept.nbytes + threads * self.block * each

    def _work(self) -> "_Work":
        """Work arrays of one thread, and the plans of the first problem; those of others are made when needed."""
        inward, across, outward = self._parts
        work = _Work(
            _aligned((self.block, inward[0].stop, self._box[1]), self._dtype),
            _aligned((self.block, across[0].stop, self._box[0]), self._compound),
            _aligned((self.block, outward[0].stop, self._box[1]), self._dtype),
        )
        self._plan(work)
        return work

    def _plan(self, work: "_Work") -> None:
        """Plans of the next problem of a block."""
        k = len(work.plans)
        forth, back = (self._spectrum[k, part[0]] for part in self._parts[::2])

        def plan(source: Array, target: Array, direction: str) -> Any:
            return pyfftw.FFTW(source, target, axes=(1,), direction=direction, flags=("FFTW_ESTIMATE",))

        lines = work.lines[k]
        work.plans.append(
            (
                plan(work.given[k], forth, "FFTW_FORWARD"),
                plan(lines, lines, "FFTW_FORWARD"),
                plan(lines, lines, "FFTW_BACKWARD"),
                plan(back, work.found[k], "FFTW_BACKWARD"),
            )
        )

    def filter(self, values: Array, corner: tuple[int, int], symbol: Array, out: Array) -> None:
        """Transform values placed at a corner of the box, multiply by the symbol, transform back into ``out``.

        All have an axis of problems first. ``symbol`` is a quadrant of an even one, (count, second, first direction).
        """
        if len(values) <= self.block:
            self._filter_block(values, corner, symbol, out)
            return
        for start in range(0, len(values), self.block):
            block = slice(start, start + self.block)
            self._filter_block(values[block], corner, symbol[block], out[block])

    def _filter_block(self, values: Array, corner: tuple[int, int], symbol: Array, out: Array) -> None:
        count, top, left = len(values), *corner
        bottom, right = top + values.shape[1], left + values.shape[2]
        loaded, back = self._kept[:count, :, : self._rows[0]], self._kept[:count, :, : self._rows[1]]
        middle = symbol.shape[2]
        while len(self._works[0].plans) < count:
            self._plan(self._works[0])

        def inward(part: slice, work: _Work) -> None:
            given, rows = values[:, part], work.given[:count]
            if left:
                rows[:, :, :left] = 0.0
            rows[:, : given.shape[1], left:right] = given
            rows[:, :, right:] = 0.0
            for k in range(count):
                forth = work.plans[k][0]
                if not self._whole:
                    forth.update_arrays(work.given[k], self._spectrum[k, part])
                forth.execute()

        def across(part: slice, work: _Work) -> None:
            quadrant, lines = symbol[:, part], work.lines[:count]
            if top:
                lines[:, :, :top] = 0.0
            lines[:, :, top:bottom] = loaded[:, part]
            lines[:, :, bottom:] = 0.0
            for k in range(count):
                work.plans[k][1].execute()
            used = lines[:, : quadrant.shape[1]]
            used[:, :, :middle] *= quadrant
            used[:, :, middle:] *= quadrant[:, :, middle - 2 : 0 : -1]
            for k in range(count):
                work.plans[k][2].execute()
            back[:, part] = lines[:, :, : back.shape[2]]

        def outward(part: slice, work: _Work) -> None:
            target = out[:, part]
            for k in range(count):
                again = work.plans[k][3]
                if not self._whole:
                    again.update_arrays(self._spectrum[k, part], work.found[k])
                again.execute()
            found = work.found[:count, : target.shape[1], : out.shape[2]]
            np.copyto(target, found, casting="same_kind")

        _share(inward, self._parts[0], self._works)
        _share(across, self._parts[1], self._works)
        _share(outward, self._parts[2], self._works)


@dataclass
class _Work:
    """Arrays of one thread, (block, ...), and the plans of every problem of a block."""

    given: Array
    lines: Array
    found: Array
    plans: list[tuple[Any, ...]] = field(default_factory=list)


def _aligned(shape: tuple[int, int, int], dtype: Any) -> Array:
    """Zeros of which every problem begins as FFTW likes it, so that the plans of all are alike."""
    size = -(-shape[1] * shape[2] // 16) * 16
    return pyfftw.zeros_aligned((shape[0], size), dtype)[:, : shape[1] * shape[2]].reshape(shape)


def _pieces(count: int, row_bytes: int, multiple: int = 1) -> list[slice]:
    """Cut rows into pieces of one length, :data:`PIECE_BYTES` each at most; the last may reach beyond the rows."""
    parts = -(-count // max(8, PIECE_BYTES // row_bytes))
    size = count if parts == 1 else -(-count // (multiple * parts)) * multiple
    return [slice(start, start + size) for start in range(0, count, size)]


def _share(do: Callable[[slice, _Work], None], parts: list[slice], works: Sequence[_Work]) -> None:
    """Do it on every piece; helpers take pieces too, and nobody waits for a helper that has not begun."""
    if len(works) == 1 or len(parts) == 1:
        for part in parts:
            do(part, works[0])
        return
    waiting = deque(parts)

    def drain(own: _Work) -> None:
        while waiting:
            try:
                part = waiting.popleft()
            except IndexError:
                return
            do(part, own)

    helpers = [_cache.pool(len(works)).submit(drain, own) for own in works[1 : len(parts)]]
    drain(works[0])
    for helper in helpers:
        if not helper.cancel():
            helper.result()


class Convolution:
    """Displacement of ``target`` cells under the pressure on a window of them, of a stack of problems; in dx/E* and E*.

    Parameters
    ----------
    target : (int, int)
        Shape of the grids.
    aspects : (count,) array_like
        dy/dx of every problem.
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
        aspects: ArrayLike,
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
        self.corner = first
        self._symbol = _kernels("love", box, aspects, dtype)
        self._transform = _cache.get((rows, box, dtype, threads), lambda: _Transform(rows, box, dtype, threads))

    def __call__(self, pressure: Array, out: Array) -> Array:
        """Write the displacement (count, nx, ny) into ``out`` and return it."""
        self._transform.filter(pressure, self.corner, self._symbol, out)
        return out

    def select(self, rows: Indices) -> Self:
        """The same for some problems of the stack."""
        if len(rows) == len(self._symbol):
            return self
        chosen = copy(self)
        chosen._symbol = self._symbol[rows]
        return chosen


class Preconditioner(Convolution):
    """Approximate inverse of the convolution of a stack: that of the periodic kernel, in single precision."""

    def __init__(self, shape: tuple[int, int], aspects: ArrayLike, threads: int = 2) -> None:
        box = (fast_length(shape[0]), fast_length(shape[1]))
        threads = useful_threads(box, threads)
        rows = (shape[0], shape[0])
        self.corner = (0, 0)
        self._symbol = _kernels("inverse", box, aspects, "float32")
        self._transform = _cache.get((rows, box, "float32", threads), lambda: _Transform(rows, box, "float32", threads))


def useful_threads(box: tuple[int, int], wanted: int) -> int:
    """One for small transforms, and in workers: threads do not survive a fork, and a pool fills the machine."""
    worker = _forked or multiprocessing.parent_process() is not None
    return 1 if worker or box[0] * box[1] < THREADED_POINTS else min(wanted, os.cpu_count() or 1)


def _kernels(kind: str, box: tuple[int, int], aspects: ArrayLike, dtype: str) -> Array:
    """Kernels (count, second, first direction) of a stack, those not kept from before computed together."""
    keys = [(kind, box, aspect, dtype) for aspect in np.asarray(aspects, dtype=np.float64).tolist()]
    kept = {key: _cache.get(key) for key in keys}
    missing = [key for key, kernel in kept.items() if kernel is None]
    if missing:
        made = _MAKERS[kind](box, [key[2] for key in missing], dtype)
        for key, own in zip(missing, made if len(made) == 1 else [*map(np.array, made)], strict=True):
            kept[key] = _cache.get(key, lambda own=own: own)
    return np.stack([kept[key] for key in keys]) if len(keys) > 1 else kept[keys[0]][None]


def _love_kernels(box: tuple[int, int], aspects: Sequence[float], dtype: str = "float64") -> Array:
    """Transform of Love's coefficients wrapped into the box, over its points, a quadrant as the kept spectrum lies.

    In single precision the kept one rounded.
    """
    if dtype != "float64":
        return _kernels("love", box, aspects, "float64").astype(dtype)
    quadrant = (box[0] // 2 + 1, box[1] // 2 + 1)
    symbol = dctn(influence_coefficients(quadrant, np.array(aspects)), type=1, axes=(1, 2), overwrite_x=True)
    symbol /= box[0] * box[1]
    return np.ascontiguousarray(symbol.transpose(0, 2, 1))


def _inverse_kernels(box: tuple[int, int], aspects: Sequence[float], dtype: str = "float32") -> Array:
    """Reciprocal of the transform of the wrapped coefficients, over the number of points of the box."""
    transformed = _kernels("love", box, aspects, "float64") * (box[0] * box[1])
    floor = transformed.max(axis=(1, 2), keepdims=True) * np.finfo(np.float32).eps
    return np.asarray(1.0 / (np.maximum(transformed, floor) * (box[0] * box[1])), dtype=dtype)


_MAKERS = {"love": _love_kernels, "inverse": _inverse_kernels}
