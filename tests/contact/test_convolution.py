"""The planned convolution against plain summation, under threads and forks, and the bound of its cache."""

import concurrent.futures
import multiprocessing
import os
from itertools import count

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from loaded_tca import threads
from loaded_tca.contact import convolution
from loaded_tca.contact.convolution import Convolution, Preconditioner, fast_length
from loaded_tca.contact.love import influence_coefficients
from loaded_tca.threads import allowed_threads
from tests.interrupts import Signal, interrupted, raise_signal

DOUBLE = 1e-13  # some hundred roundings of a transform, relative to the largest value
SINGLE = 1e-5
MODULES = convolution, threads


def summed(pressure, aspect):
    """The same by summation over all pairs of cells."""
    nx, ny = pressure.shape
    love = influence_coefficients((nx, ny), aspect)
    i, j = np.arange(nx), np.arange(ny)
    kernel = love[np.abs(i[:, None] - i)[:, None, :, None], np.abs(j[:, None] - j)[None, :, None, :]]
    return np.einsum("abcd,cd->ab", kernel, pressure)


def convolved(pressure, aspect, target=None, **options):
    """Displacement of one problem."""
    target = target or pressure.shape
    out = np.empty((1, *target), dtype=options.get("dtype", "float64"))
    return Convolution(target, [aspect], **options)(pressure[None], out)[0]


@pytest.mark.parametrize("aspect", [1.0, 0.02, 500.0])
@pytest.mark.parametrize("shape", [(5, 7), (1, 9), (9, 1), (1, 1), (16, 16), (17, 33)])
def test_convolution_agrees_with_summation(shape, aspect, rng):
    pressure = rng.random(shape)
    expected = summed(pressure, aspect)
    found = convolved(pressure, aspect)
    assert_allclose(found, expected, rtol=DOUBLE)


@pytest.mark.parametrize(
    "window", [(slice(5, 11), slice(9, 20)), (slice(21, 24), slice(0, 1)), (slice(0, 24), slice(29, 30))]
)
def test_pressure_on_a_window_displaces_the_whole_grid(window, rng):
    pressure = np.zeros((24, 30))
    pressure[window] = rng.random(pressure[window].shape)
    found = convolved(pressure[window], 0.7, pressure.shape, window=window)
    assert_allclose(found, summed(pressure, 0.7), rtol=DOUBLE)


def test_single_precision_agrees_to_its_digits(rng):
    pressure = rng.random((40, 30)).astype(np.float32)
    found = convolved(pressure, 2.0, dtype="float32")
    assert_allclose(found, summed(pressure.astype(float), 2.0), rtol=SINGLE)


def test_convolution_leaves_its_input_alone(rng):
    pressure = rng.random((8, 8))
    before = pressure.copy()
    first, second = convolved(pressure, 1.0), convolved(pressure, 1.0)
    assert np.array_equal(pressure, before)
    assert np.array_equal(first, second)  # the same plan for the same numbers


def test_preconditioner_nearly_inverts_the_convolution_in_the_middle(rng):
    """A local pressure without mean comes back from its displacement, but for the periodic images."""
    pressure = np.zeros((64, 64))
    pressure[24:40, 24:40] = rng.standard_normal((16, 16))
    pressure[24:40, 24:40] -= pressure[24:40, 24:40].mean()
    displacement = convolved(pressure, 1.0).astype(np.float32)
    back = Preconditioner((64, 64), [1.0])(displacement[None], np.empty((1, 64, 64), dtype=np.float32))[0]
    back -= back[24:40, 24:40].mean()
    assert_allclose(back[24:40, 24:40], pressure[24:40, 24:40], atol=0.05 * np.abs(pressure).max())


@pytest.mark.parametrize("aspect", [1.0, 0.001, 1000.0])
@pytest.mark.parametrize("box", [(2, 2), (16, 16), (32, 48), (10, 128)])
def test_symbol_of_the_periodic_kernel_is_positive(box, aspect):
    assert convolution._inverse_kernels(box, [aspect], "float32").min() > 0.0


def test_fast_lengths_are_even_few_and_hardly_too_long():
    lengths = [fast_length(n) for n in range(1, 3000)]
    assert all(length >= n and length % 2 == 0 for n, length in enumerate(lengths, 1))
    assert max(length / n for n, length in enumerate(lengths, 1) if n > 16) <= 1.2
    assert len(set(lengths)) < 60


def test_results_do_not_depend_on_threads(rng):
    pressure = rng.random((700, 600))
    one, two = (convolved(pressure, 1.0, threads=n) for n in (1, 2))
    assert np.array_equal(one, two)  # threads share lines of a transform, and each line is of one thread


def test_small_transforms_keep_to_one_thread():
    assert convolution.useful_threads((64, 64), 4) == 1
    assert convolution.useful_threads((1024, 1024), 4) == allowed_threads(4)


def test_cache_stays_bounded(monkeypatch, rng):
    monkeypatch.setattr(convolution, "CACHE_BYTES", 300_000)
    cache = convolution._Cache()
    monkeypatch.setattr(convolution, "_cache", cache)
    for n in range(20, 60, 4):
        pressure = rng.random((n, n))
        assert_allclose(convolved(pressure, 1.0)[0], summed(pressure, 1.0)[0], rtol=DOUBLE)
        assert cache.bytes == sum(item.nbytes for item in cache.items.values())
        assert cache.bytes <= 300_000 or len(cache.items) == 1


def _centre_displacement(n):
    return float(convolved(np.ones((n, n)), 1.0, threads=2)[n // 2, n // 2])


def test_large_symbols_in_double_that_others_are_made_of_are_not_kept(monkeypatch):
    """They would displace what the next solve takes; what is made of them is the same."""
    kept, made = [], []
    for most in (convolution.MOST_BESIDE, 1000):
        monkeypatch.setattr(convolution, "MOST_BESIDE", most)
        monkeypatch.setattr(convolution, "_cache", convolution._Cache())
        made += [convolution._kernels(kind, (64, 64), [1.0], "float32") for kind in ("love", "inverse")]
        kept.append({key[-1] for key in convolution._cache.items})
    assert kept == [{"float32", "float64"}, {"float32"}]
    assert_array_equal(made[:2], made[2:])


def test_threads_of_one_process_do_not_disturb_each_other():
    sizes = [16, 24, 33, 220] * 6
    expected = [_centre_displacement(n) for n in sizes]
    with concurrent.futures.ThreadPoolExecutor(4) as pool:
        assert_allclose(list(pool.map(_centre_displacement, sizes)), expected, rtol=DOUBLE)


@pytest.mark.quick_cases("fork")
@pytest.mark.parametrize("method", sorted(set(multiprocessing.get_all_start_methods()) & {"fork", "spawn"}))
@pytest.mark.filterwarnings("ignore:This process .* is multi-threaded:DeprecationWarning")
def test_workers_convolve_after_their_parent_used_threads(method):
    """A child of fork must neither use the plans of its parent nor wait for threads it does not have."""
    convolved(np.ones((600, 600)), 1.0, threads=2)
    expected = _centre_displacement(220)
    context = multiprocessing.get_context(method)
    with concurrent.futures.ProcessPoolExecutor(1, mp_context=context) as pool:
        assert pool.submit(_centre_displacement, 220).result(timeout=60) == pytest.approx(expected, rel=DOUBLE)
        assert pool.submit(convolution.useful_threads, (2048, 2048), 2).result(timeout=60) == 1


@pytest.mark.parametrize(("shape", "step"), [((3, 12, 12), 1), ((1, 200, 190), 7)])  # a stack; on two threads
def test_exception_at_any_line_leaves_the_next_convolution_right(monkeypatch, rng, shape, step):
    """One out of a signal comes anywhere, and what is kept must not have half of something."""
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: {0, 1}, raising=False)
    values, aspects = rng.random(shape), np.linspace(1.0, 1.5, shape[0])

    def convolve():
        return Convolution(shape[1:], aspects)(values, np.empty(shape))

    right = convolve()
    for line in count(1, step):
        monkeypatch.setattr(convolution, "_cache", convolution._Cache())
        try:
            if not interrupted(MODULES, line, raise_signal, convolve):
                break
        except Signal:
            assert np.array_equal(convolve(), right), line  # exact: the same operations on the same numbers
    assert line > 20


def test_convolution_inside_an_interrupted_one_leaves_it_right(rng):
    """A handler of a signal may solve contacts of its own, on the same grids."""
    values, others = rng.random((2, 2, 12, 12))
    convolve = Convolution((12, 12), [1.0, 1.0])
    right, right_of_others = (convolve(own, np.empty(own.shape)) for own in (values, others))
    inner, outer = np.empty(values.shape), np.empty(values.shape)

    def handler():
        Convolution((12, 12), [1.0, 1.0])(others, inner)

    for line in count(1):
        if not interrupted(MODULES, line, handler, lambda: convolve(values, outer)):
            break
        assert np.array_equal(outer, right), line
        assert np.array_equal(inner, right_of_others), line
    assert line > 10


@pytest.mark.parametrize(("dtype", "tolerance"), [("float64", DOUBLE), ("float32", 1e-6)])  # roundings as above
def test_large_transforms_in_blocks_have_the_result_of_those_in_one(monkeypatch, dtype, tolerance):
    shape, window, aspects = (330, 270), (slice(41, 318), slice(11, 220)), [0.7]
    pressure = np.random.default_rng(5).random((1, 277, 209))
    results = []
    for most, cores in ((2**40, 1), (0, 1), (0, 2)):
        monkeypatch.setattr(convolution, "LARGEST_WHOLE", most)
        filtered = convolution.Convolution(shape, aspects, window, dtype, cores)
        results.append(filtered(pressure, np.empty((1, *shape))))
    whole, blocks, by_two = results
    assert_allclose(blocks, whole, rtol=0, atol=tolerance * whole.max())
    assert (by_two == blocks).all()


def test_large_work_arrays_are_not_kept(monkeypatch):
    monkeypatch.setattr(convolution, "_cache", convolution._Cache())
    monkeypatch.setattr(convolution, "LARGEST_KEPT", 0)
    convolution.Preconditioner((8, 8), [1.0])
    assert {key[0] for key in convolution._cache.items} == {"love", "inverse"}
