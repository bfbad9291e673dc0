"""REXS, the open exchange format of gearbox data: files read into models, stages of models as scenes."""

from loaded_tca.exchange.files import parse_rexs, read_rexs, with_attributes
from loaded_tca.exchange.model import Attribute, Component, Model
from loaded_tca.exchange.stage import ImportedStage, describe_stages, import_stage

__all__ = [
    "Attribute",
    "Component",
    "ImportedStage",
    "Model",
    "describe_stages",
    "import_stage",
    "parse_rexs",
    "read_rexs",
    "with_attributes",
]
