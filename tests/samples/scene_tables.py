"""Changes of the table that a scene file holds."""


def changed(table, changes):
    """The table with values at paths as ``pinion.teeth``; None takes a key away."""
    for path, value in changes.items():
        *sections, name = path.split(".")
        place = table
        for section in sections:
            place = place.setdefault(section, {})
        if value is None:
            place.pop(name, None)
        else:
            place[name] = value
    return table
