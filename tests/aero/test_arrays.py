"""The one place that knows NumPy from torch."""

import numpy as np
import torch

from flapenv.aero.arrays import as_arrays, as_like, as_numpy, as_result


def test_python_scalars_adapt_to_the_arrays_beside_them() -> None:
    xp, array, scalar = as_arrays(np.float32([1, 2]), 0.5)
    assert xp is np
    assert array.dtype == scalar.dtype == np.float32
    assert as_arrays(1, 2.0)[1].dtype == np.float64
    assert as_arrays(np.array([1, 2]), 0.5)[1].dtype == np.float64  # whole numbers become floats


def test_one_tensor_makes_the_rest_tensors_of_its_type() -> None:
    xp, a, b, c = as_arrays(np.ones(2), torch.zeros(2, dtype=torch.float32), 3)
    assert xp is torch
    assert {value.dtype for value in (a, b, c)} == {torch.float32}
    assert as_arrays(torch.ones(2, dtype=torch.int64), 0.5)[2] == 0.5  # a whole-number tensor truncates nothing
    widest = as_arrays(torch.zeros(1, dtype=torch.float32), torch.zeros(1, dtype=torch.float64))
    assert {value.dtype for value in widest[1:]} == {torch.float64}
    assert as_like(a, np.ones(3))[0].dtype == torch.float32
    assert as_numpy(torch.ones(2, requires_grad=True)).tolist() == [1, 1]


def test_results_without_axes_become_python_floats() -> None:
    assert type(as_result(np.float64(2.0))) is float
    assert type(as_result(np.array(2.0))) is float
    assert isinstance(as_result(np.ones(2)), np.ndarray)
