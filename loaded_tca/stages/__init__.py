"""Planetary stages: a sun, planets and a ring that share a torque, above the analyses of their two meshes."""

from typing import TYPE_CHECKING

from loaded_tca.lazy import lazy_names

if TYPE_CHECKING:
    from loaded_tca.stages.analyse import analyse_stage, rebalanced
    from loaded_tca.stages.files import describe_stage_keys, parse_stage, read_stage
    from loaded_tca.stages.rating import StageRating, StageSpectrumRating
    from loaded_tca.stages.result import StageResult
    from loaded_tca.stages.sections import Stage
else:
    __getattr__, __dir__ = lazy_names(__name__)

__all__ = [
    "Stage",
    "StageRating",
    "StageResult",
    "StageSpectrumRating",
    "analyse_stage",
    "describe_stage_keys",
    "parse_stage",
    "read_stage",
    "rebalanced",
]
