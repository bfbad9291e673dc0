"""Studies of many variants of a scene, with the key figures of each, and designs of micro-geometry.

The engine is any ``concurrent.futures.Executor``. An executor belongs to its caller; a study asks it for one task per
variant, or for several quick ones, writes down each that is done, and goes on where it stopped when it is run again.
"""

from typing import TYPE_CHECKING

from loaded_tca.lazy import lazy_names

if TYPE_CHECKING:
    from loaded_tca.studies.design import DesignModel, DesignResult, load_design, optimise, robustness
    from loaded_tca.studies.double_helical import halves_figures
    from loaded_tca.studies.other_figures import revolution_figures, tribology_figures
    from loaded_tca.studies.ranking import figures, rank_combinations, rank_variants, study_summary
    from loaded_tca.studies.rating import rating_figures, shortfall, tolerance_class_study
    from loaded_tca.studies.read import parse_study, read_study, vh_study
    from loaded_tca.studies.rows import load_study
    from loaded_tca.studies.run import process_pool, run_study
    from loaded_tca.studies.stage import stage_figures
    from loaded_tca.studies.study import Study
    from loaded_tca.studies.tables import to_excel, to_pandas
else:
    __getattr__, __dir__ = lazy_names(__name__)

__all__ = [
    "DesignModel",
    "DesignResult",
    "Study",
    "figures",
    "halves_figures",
    "load_design",
    "load_study",
    "optimise",
    "parse_study",
    "process_pool",
    "rank_combinations",
    "rank_variants",
    "rating_figures",
    "read_study",
    "revolution_figures",
    "robustness",
    "run_study",
    "shortfall",
    "stage_figures",
    "study_summary",
    "to_excel",
    "to_pandas",
    "tolerance_class_study",
    "tribology_figures",
    "vh_study",
]
