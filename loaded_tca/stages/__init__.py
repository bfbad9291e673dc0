"""Planetary stages: a sun, planets and a ring that share a torque, above the analyses of their two meshes."""

from loaded_tca.stages.analyse import analyse_stage, rebalanced
from loaded_tca.stages.files import describe_stage_keys, parse_stage, read_stage
from loaded_tca.stages.result import StageResult
from loaded_tca.stages.sections import Stage

__all__ = [
    "Stage",
    "StageResult",
    "analyse_stage",
    "describe_stage_keys",
    "parse_stage",
    "read_stage",
    "rebalanced",
]
