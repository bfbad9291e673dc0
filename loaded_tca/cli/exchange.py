"""The commands that read and write models of other programs."""

from __future__ import annotations

import argparse

from loaded_tca.cli.commands import check_files, index_of_torque, result_file
from loaded_tca.cli.terminal import print_files, print_summary
from loaded_tca.errors import require


def import_model(options: argparse.Namespace) -> None:
    """Write a stage of a REXS model as a scene, or show the stages that it has."""
    from loaded_tca.exchange import describe_stages, import_stage, read_rexs
    from loaded_tca.results.files import replace_file

    model = read_rexs(options.model)
    if options.stage is None:
        require((options.out is None, f"--out {options.out}: needs --stage"))
        print(describe_stages(model))
        return
    imported = import_stage(model, options.stage, load_case=options.load_case, torque_Nm=options.torque)
    if options.out is None:
        print(imported.to_toml(), end="")
        return
    check_files([options.out], options.model)
    replace_file(options.out, imported.to_toml().encode())
    print_summary(imported.summary(), [options.out])


def export_model(options: argparse.Namespace) -> None:
    """Write a REXS model with the numbers of a result."""
    from loaded_tca.output.rexs import write_rexs
    from loaded_tca.results.mesh_cycle import MeshCycle

    check_files([options.out], options.model)
    result = MeshCycle.load(result_file(options.result))
    torque = index_of_torque(options.torque, result)
    print_files([write_rexs(result, options.model, options.stage, options.out, torque)])
