"""Fast convolution of pressures with influence coefficients: planned, pruned transforms.

The only module that knows FFTW. Plans and their work arrays are kept per thread, since neither may be shared
while in use; what is kept is bounded by :data:`CACHE_BYTES`. Those that an exception finds in use are given up.
"""

import functools
import math
import os
import threading
from abc import ABC, abstractmethod
from collections import OrderedDict
from collections.abc import Callable, Hashable, Iterator, Sequence
from typing import Any

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from loaded_tca.arrays import Array, Indices
from loaded_tca.contact.love import influence_coefficients
from loaded_tca.lazy import hidden
from loaded_tca.threads import allowed_threads, shared

with hidden("dask.array.fft"), hidden("scipy.fftpack"):  # of interfaces that nobody here uses; they take far longer
    import pyfftw

Window = tuple[slice, slice]
Rows = Indices | slice
ALL = slice(None)

CACHE_BYTES = 256 * 2**20
# Symbols in double precision that others are made of are kept up to this; larger ones would displace the others.
MOST_BESIDE = 2**24
# Work arrays of a transform that take more than this are made anew: they would displace symbols, which take longer.
LARGEST_KEPT = 2**24
# Half-transformed data of more bytes are kept in blocks: that costs a tenth of the time where they fit the cache.
LARGEST_WHOLE = 2**23
# Rows that are written as columns together.
SQUARE = 64
# Fewer points of a transform than this are not worth a second thread.
THREADED_POINTS = 2**17
# A piece of a transform, with its part of the kernel, should stay in the cache of a core.
PIECE_BYTES = 2**18
# So should the work arrays of the small problems that are transformed together; more problems than this save nothing.
BLOCK_BYTES = 2**18
LARGEST_BLOCK = 16


def _mark_fork() -> None:
    """The child of a fork plans anew: another thread may have been using what it would find."""
    global _cache
    _cache = _Cache()


class _Cache(threading.local):
    """Least recently used plans and spectra of one thread, bounded in bytes."""

    def __init__(self) -> None:
        self.items: OrderedDict[Hashable, Any] = OrderedDict()
        self.bytes = 0

    def find(self, key: Hashable) -> Any:
        """Return what is kept under the key, None if nothing is."""
        if key in self.items:
            self.items.move_to_end(key)
        return self.items.get(key)

    def keep(self, key: Hashable, made: Any) -> Any:
        """Keep something new under a key, and return it."""
        # An exception in between leaves the count too large, until all that is older has gone.
        self.bytes += made.nbytes
        replaced = self.items.pop(key, None)
        self.items[key] = made
        self.bytes -= 0 if replaced is None else replaced.nbytes
        while self.bytes > CACHE_BYTES and len(self.items) > 1:
            self.bytes -= self.items.popitem(last=False)[1].nbytes
        if len(self.items) == 1:
            self.bytes = made.nbytes
        return made

    def idle(self, key: Hashable, make: Callable[[], "_Transform"]) -> "_Transform":
        """Return the transform that is kept under the key; make and keep one if there is none or it is in use."""
        kept = self.find(key)
        if kept is None or kept.in_use:
            kept = make()
            return self.keep(key, kept) if kept.nbytes <= LARGEST_KEPT else kept
        return kept


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


class _Transform(ABC):
    """Plans and work arrays of transforms that multiply problems with even symbols in the Fourier space.

    ``in_use`` stays true where an exception ends a call: nothing is known of the work arrays then. A call that a signal
    interrupts has it true, too, while the handler computes on its own.
    """

    nbytes = 0
    in_use = False

    def __call__(self, values: Array, corner: tuple[int, int], symbol: Array, out: Array) -> None:
        """Filter values (count, rows, columns), placed at a corner of the box, into ``out``."""
        self.in_use = True
        self._filter(values, corner, symbol, out)
        self.in_use = False

    @abstractmethod
    def _filter(self, values: Array, corner: tuple[int, int], symbol: Array, out: Array) -> None:
        """Transform the values, multiply by the symbols as :func:`_kernels` has them, transform back."""


class _SmallTransforms(_Transform):
    """Planned transforms of the rows of several small problems in periodic boxes, and back.

    Every problem has plans of its own, all alike, so that its result is the same to the last bit wherever it stands
    and whatever stands beside it. ``rows`` counts those that hold data on the way forth and on the way back.
    """

    def __init__(self, rows: tuple[int, int], columns: int, box: tuple[int, int], dtype: str) -> None:
        # Rows a power of two apart share their place in the cache: a few unused ones keep them apart.
        lines = (box[1] // 2 + 1, box[0] + 8)
        self._rows, self._box, self._columns = rows, box, columns
        self.nbytes = _small_bytes(rows, box, dtype)
        self._block = min(LARGEST_BLOCK, max(1, BLOCK_BYTES // self.nbytes))
        self.nbytes *= self._block
        # What is beside the data in the first two stays zero: transforms leave their source as it is, but the last.
        self._given, self._found = (_aligned((self._block, count, box[1]), dtype) for count in rows)
        self._loaded, self._moved = (_aligned((self._block, *lines), np.result_type(dtype, "c8")) for _ in "12")
        self._returned = _aligned((1, *lines), np.result_type(dtype, "c8"))[0]  # of one problem after the other
        self._forth: list[tuple[Callable[[], None], ...]] = []
        self._back: list[tuple[Callable[[], None], ...]] = []

    def _plan(self, k: int) -> None:
        """Plans of one more problem, made when it is needed."""
        given, spectrum, loaded, moved = self._given[k], self._found[k], self._loaded[k], self._moved[k]
        within, inward, outward = slice(0, self._box[0]), slice(0, self._rows[0]), slice(0, self._rows[1])
        returned = self._returned
        plans = [
            _planned(*arrays).execute
            for arrays in (
                (given, loaded.T[inward], "FFTW_FORWARD"),
                (loaded[:, within], moved[:, within], "FFTW_FORWARD"),
                (moved[:, within], returned[:, within], "FFTW_BACKWARD"),
                (returned.T[outward], spectrum, "FFTW_BACKWARD", "FFTW_DESTROY_INPUT"),
            )
        ]
        self._forth.append(tuple(plans[:2]))
        self._back.append(tuple(plans[2:]))

    def _filter(self, values: Array, corner: tuple[int, int], symbol: Array, out: Array) -> None:  # noqa: ARG002
        """Transform values at the first corner, multiply by the symbols, transform back."""
        while len(self._forth) < min(self._block, len(values)):
            self._plan(len(self._forth))
        for start in range(0, len(values), self._block):
            given = values[start : start + self._block]
            count = len(given)
            self._given[:count, :, : self._columns] = given
            for rows_forth, lines_forth in self._forth[:count]:
                rows_forth()
                lines_forth()
            moved = self._moved[:count, :, : self._box[0]]
            np.multiply(moved, symbol[start : start + count], out=moved)
            for lines_back, rows_back in self._back[:count]:
                lines_back()
                rows_back()
            out[start : start + count] = self._found[:count, :, : out.shape[2]]


def _planned(source: Array, target: Array, direction: str, *flags: str) -> Any:
    """Plan the transforms of all rows.

    Plans are estimated, as measured ones would make the last bits of results a matter of chance. Between two arrays
    estimated ones are nearly as fast as measured ones; in place they take up to 2.8 times as long.
    """
    return pyfftw.FFTW(source, target, axes=(1,), direction=direction, flags=("FFTW_ESTIMATE", *flags))


def _small_bytes(rows: tuple[int, int], box: tuple[int, int], dtype: str) -> int:
    """Bytes of the work arrays of one problem."""
    return (sum(rows) * box[1] + 4 * (box[1] // 2 + 1) * (box[0] + 8)) * np.dtype(dtype).itemsize


def _aligned(shape: tuple[int, int, int], dtype: Any) -> Array:
    """Zeros of which every problem begins as FFTW likes it, so that the plans of all are alike."""
    size = -(-shape[1] * shape[2] // 16) * 16
    return pyfftw.zeros_aligned((shape[0], size), dtype)[:, : shape[1] * shape[2]].reshape(shape)


class _LargeTransform(_Transform):
    """Planned transforms of rows of real data in a periodic box, and back, in pieces that fit the cache.

    ``rows`` counts those that hold data on the way forth and on the way back: no others are transformed or kept. The
    doubled box itself exists in pieces only, one at a time in the work arrays of each thread, and threads need not wait
    for each other within a piece. What is kept between the two directions is (blocks, second direction, rows): one
    block of all rows, or, where that is large (``folded``), one for each piece, which fits the cache. There transforms
    of 6144 and 7168 points take half the time, and the symbol is a quadrant, to be unfolded piece by piece.
    """

    def __init__(self, rows: tuple[int, int], box: tuple[int, int], dtype: str, threads: int, folded: bool) -> None:
        # The second direction first, so that transforms along the first run over contiguous data.
        compound, half = np.result_type(dtype, np.complex64), box[1] // 2 + 1
        across = _pieces(half, box[0] * compound.itemsize)
        deep = _pieces(max(rows), box[1] * np.dtype(dtype).itemsize, 8)  # whole eights of rows are aligned
        depth, lines = deep[0].stop, across[0].stop
        # Rows a power of two apart share their place in the cache: a few unused ones keep them apart.
        shape = (len(deep), depth) if folded else (1, (deep[-1].stop + 15) // 8 * 8)
        self._kept = pyfftw.zeros_aligned((shape[0], across[-1].stop, shape[1]), compound)
        in_blocks = (divmod(piece.start, shape[1]) for piece in deep)
        self._pieces = [self._kept[block, :half, start : start + depth].T for block, start in in_blocks]
        self._depth, self._folded = depth, folded
        self._rows, self._across = rows, across
        self._inward, self._outward = (range(-(-count // depth)) for count in rows)
        self._plans, self.nbytes = [], self._kept.nbytes
        size = max(lines * box[0], -(-depth * box[1] // 2))
        for _ in range(threads):
            # What a piece takes in either direction stands in the same place.
            sources, targets = (pyfftw.zeros_aligned(size, compound) for _ in "12")
            given, output = (room.view(dtype)[: depth * box[1]].reshape(depth, box[1]) for room in (sources, targets))
            loaded, moved = (room[: lines * box[0]].reshape(lines, box[0]) for room in (sources, targets))
            forth = _planned(given, self._pieces[0], "FFTW_FORWARD")
            lines_forth, lines_back = _planned(loaded, moved, "FFTW_FORWARD"), _planned(moved, loaded, "FFTW_BACKWARD")
            back = _planned(self._pieces[0], output, "FFTW_BACKWARD", "FFTW_DESTROY_INPUT")
            self._plans.append((forth, lines_forth, lines_back, back))
            self.nbytes += sources.nbytes + targets.nbytes

    def _filter(self, values: Array, corner: tuple[int, int], symbol: Array, out: Array) -> None:
        """Problems by turns."""
        for given, one_symbol, target in zip(values, symbol, out, strict=True):
            self._filter_one(given, corner, one_symbol, target)

    def _filter_one(self, values: Array, corner: tuple[int, int], symbol: Array, out: Array) -> None:
        """Transform values (rows, columns), multiply by the symbol, transform back."""
        top, left = corner
        bottom, right = top + values.shape[0], left + values.shape[1]
        depth, half = self._depth, symbol.shape[1]

        def inward(piece: int, forth: Any, *_: Any) -> None:
            given, rows = values[piece * depth : (piece + 1) * depth], forth.input_array
            rows[:, :left] = 0.0
            rows[: len(given), left:right] = given
            rows[:, right:] = 0.0
            forth.update_arrays(rows, self._pieces[piece])
            forth.execute()

        def across(part: slice, _: Any, forth: Any, again: Any, __: Any) -> None:
            lines, own = forth.input_array, symbol[part]
            lines[:, :top] = 0.0
            for line, block in _beside(lines[:, top:bottom], self._kept[:, part]):
                line[...] = block
            lines[:, bottom:] = 0.0
            forth.execute()
            if self._folded:
                quadrant, own = own, lines.view(own.dtype)[: len(own), : lines.shape[1]]
                own[:, :half], own[:, half:] = quadrant, quadrant[:, half - 2 : 0 : -1]
            moved = forth.output_array[: len(own)]
            np.multiply(moved, own, out=moved)
            again.execute()
            for line, block in _beside(lines[:, : self._rows[1]], self._kept[:, part]):
                block[...] = line

        def outward(piece: int, *plans: Any) -> None:
            target, again = out[piece * depth : (piece + 1) * depth], plans[-1]
            again.update_arrays(self._pieces[piece], again.output_array)
            again.execute()
            np.copyto(target, again.output_array[: len(target), : out.shape[1]], casting="same_kind")

        shared(inward, self._inward, self._plans)
        shared(across, self._across, self._plans)
        shared(outward, self._outward, self._plans)


def _beside(lines: Array, blocks: Array) -> Iterator[tuple[Array, Array]]:
    """Views of lines (lines, rows), each with that of the blocks (blocks, lines, depth) which has the same rows."""
    depth = blocks.shape[2]
    whole, rest = divmod(lines.shape[1], depth)
    if whole:
        yield lines[:, : whole * depth].reshape(len(lines), whole, depth), blocks[:whole].transpose(1, 0, 2)
    if rest:
        yield lines[:, whole * depth :], blocks[whole, :, :rest]


def _pieces(count: int, row_bytes: int, multiple: int = 1) -> list[slice]:
    """Cut rows into pieces of one length, :data:`PIECE_BYTES` each at most; the last may reach beyond the rows."""
    parts = -(-count // max(8, PIECE_BYTES // row_bytes))
    size = count if parts == 1 else -(-count // (multiple * parts)) * multiple
    return [slice(start, start + size) for start in range(0, count, size)]


class _Filter:
    """Product of stacks of problems with even symbols in the Fourier space: small ones together, large ones by turns.

    Parameters
    ----------
    corner : (int, int)
        Where in the box the values begin.
    columns : int
        Of the values; their rows and those asked for are ``rows``.
    kind, aspects, dtype
        See :func:`_kernels`, which has the symbols.
    """

    def __init__(
        self,
        rows: tuple[int, int],
        columns: int,
        corner: tuple[int, int],
        box: tuple[int, int],
        kind: str,
        aspects: ArrayLike,
        dtype: str,
        threads: int,
    ) -> None:
        threads = useful_threads(box, threads)
        small = corner == (0, 0) and _small_bytes(rows, box, dtype) <= BLOCK_BYTES
        spectrum_bytes = (box[1] + 2) * max(rows) * np.dtype(dtype).itemsize
        folded = not small and spectrum_bytes > LARGEST_WHOLE
        self._symbol, self._corner = _kernels(kind, box, aspects, dtype, folded), corner
        self._key: Hashable
        self._make: Callable[[], _Transform]
        if small:
            self._key = rows, columns, box, dtype
            self._make = functools.partial(_SmallTransforms, rows, columns, box, dtype)
        else:
            self._key = rows, box, dtype, threads, folded
            self._make = functools.partial(_LargeTransform, rows, box, dtype, threads, folded)
        self._transform = _cache.idle(self._key, self._make)

    def __call__(self, values: NDArray[Any], out: NDArray[Any], rows: Rows = ALL) -> NDArray[Any]:
        """Write the product (count, nx, ny) into ``out`` and return it; of the problems ``rows`` of the stack."""
        if self._transform.in_use:
            self._transform = _cache.idle(self._key, self._make)
        self._transform(values, self._corner, self._symbol[rows], out)
        return out


class Convolution(_Filter):
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
        rows, columns = (last[0] - first[0], target[0]), last[1] - first[1]
        super().__init__(rows, columns, first, box, "love", aspects, dtype, threads)


class Preconditioner(_Filter):
    """Approximate inverse of the convolution of a stack: that of the periodic kernel, in single precision."""

    def __init__(self, shape: tuple[int, int], aspects: ArrayLike, threads: int = 2) -> None:
        box, rows = (fast_length(shape[0]), fast_length(shape[1])), (shape[0], shape[0])
        super().__init__(rows, shape[1], (0, 0), box, "inverse", aspects, "float32", threads)


def useful_threads(box: tuple[int, int], wanted: int) -> int:
    """One for small transforms, else as many as are allowed here."""
    return 1 if box[0] * box[1] < THREADED_POINTS else allowed_threads(wanted)


def _kernels(kind: str, box: tuple[int, int], aspects: ArrayLike, dtype: str, folded: bool = False) -> Array:
    """Symbols (count, second, first direction) of a stack, those not kept from before computed together.

    The half that the transform of real data has: numpy multiplies by contiguous rows two to three times as fast as by
    quadrants, of which one half of a row is read backwards. ``folded``: the quadrants.
    """
    keys = [(kind, folded, box, aspect, dtype) for aspect in np.asarray(aspects, dtype=np.float64).tolist()]
    kept = {key: _cache.find(key) for key in keys}
    missing = [key for key, kernel in kept.items() if kernel is None]
    if missing:
        new_aspects = [key[3] for key in missing]
        if kind == "inverse":
            made = _inverse_kernels(box, new_aspects, dtype, folded)
        elif dtype == "float64":
            made = _love_kernels(box, new_aspects, folded)
        else:
            made = _in_double(box, new_aspects, folded).astype(dtype)
        for key, kernel in zip(missing, made, strict=True):
            kept[key] = _cache.keep(key, kernel if len(made) == 1 else kernel.copy())
    return np.stack([kept[key] for key in keys]) if len(keys) > 1 else kept[keys[0]][None]


def _in_double(box: tuple[int, int], aspects: Sequence[float], folded: bool) -> Array:
    """Symbols of the convolution in double precision, of which others are made, as :func:`_kernels` has them."""
    kept = [_cache.find(("love", folded, box, aspect, "float64")) for aspect in aspects]
    if 8 * box[0] * (box[1] // 2 + 1) > MOST_BESIDE and any(kernel is None for kernel in kept):
        return _love_kernels(box, aspects, folded)
    return _kernels("love", box, aspects, "float64", folded)


def _love_kernels(box: tuple[int, int], aspects: Sequence[float], folded: bool) -> Array:
    """Transform of Love's coefficients wrapped into the box, over its points, as :func:`_kernels` has it."""
    quadrant = (box[0] // 2 + 1, box[1] // 2 + 1)
    symbol = scipy.fft.dctn(influence_coefficients(quadrant, np.array(aspects)), type=1, axes=(1, 2), overwrite_x=True)
    # Rows of it contiguous, other than those of the transform.
    kernels = np.empty((len(symbol), quadrant[1], quadrant[0] if folded else box[0]))
    for start in range(0, quadrant[0], SQUARE):
        rows = slice(start, min(start + SQUARE, quadrant[0]))
        np.divide(symbol[:, rows].transpose(0, 2, 1), box[0] * box[1], out=kernels[:, :, rows])
    if not folded:
        kernels[:, :, quadrant[0] :] = kernels[:, :, quadrant[0] - 2 : 0 : -1]
    return kernels


def _inverse_kernels(box: tuple[int, int], aspects: Sequence[float], dtype: str, folded: bool = False) -> Array:
    """Reciprocal of the transform of the wrapped coefficients, over the number of points of the box."""
    points = box[0] * box[1]
    transformed = _in_double(box, aspects, folded) * points
    floor = transformed.max(axis=(1, 2), keepdims=True) * np.finfo(np.float32).eps
    np.maximum(transformed, floor, out=transformed)
    transformed *= points
    return np.divide(1.0, transformed, out=transformed).astype(dtype)
