"""REXS, the open exchange format of gearbox data: files read into models, stages of models as scenes."""

from typing import TYPE_CHECKING

from loaded_tca.lazy import lazy_names

if TYPE_CHECKING:
    from loaded_tca.exchange.files import parse_rexs, read_rexs, with_attributes
    from loaded_tca.exchange.model import Attribute, Component, Model
    from loaded_tca.exchange.stage import ImportedStage, describe_stages, import_stage
    from loaded_tca.exchange.strength import LoadBin, load_spectrum
else:
    __getattr__, __dir__ = lazy_names(__name__)

__all__ = [
    "Attribute",
    "Component",
    "ImportedStage",
    "LoadBin",
    "Model",
    "describe_stages",
    "import_stage",
    "load_spectrum",
    "parse_rexs",
    "read_rexs",
    "with_attributes",
]
