"""The contact conditions of a solution, computed apart from the solver."""

import numpy as np

from loaded_tca.contact.convolution import Convolution


def contact_conditions(solution, gap):
    """Largest violation of the contact conditions on the whole grid, over the approach from first touch."""
    aspect = solution.spacing[1] / solution.spacing[0]
    displacement = Convolution(gap.shape, [aspect])(solution.pressure[None], np.empty((1, *gap.shape)))[0]
    displacement *= solution.spacing[0] / solution.problem.contact_modulus
    excess = displacement + gap - solution.approach
    scale = solution.approach - gap.min()
    cap = solution.problem.cap
    inner = (solution.pressure > 0.0) & (solution.pressure < cap)
    complementarity = (solution.pressure[inner] * np.abs(excess[inner])).sum() / solution.pressure.sum()
    penetration = max(0.0, -excess[solution.pressure == 0.0].min(initial=0.0))
    parting = max(0.0, excess[solution.pressure >= cap].max(initial=0.0))
    return max(complementarity, penetration, parting) / scale
