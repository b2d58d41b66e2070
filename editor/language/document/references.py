"""Values of a document in which parameters, variables and roles are referred to by other names."""

from __future__ import annotations

from collections.abc import Mapping


def with_document_names(value: object, names: Mapping[str, str]) -> object:
    """Return a value with its parameters and variables under the names that the document has for them."""
    if isinstance(value, Mapping):
        if value.keys() == {"param"}:
            return {"param": names.get(str(value["param"]), value["param"])}
        return {key: with_document_names(inner, names) for key, inner in value.items()}
    return [with_document_names(inner, names) for inner in value] if isinstance(value, list) else value


def with_role_ids(value: object, role_ids: Mapping[str, str]) -> object:
    """Return plain JSON in which Values name roles by their ids instead of their names in the script."""
    if isinstance(value, list):
        return [with_role_ids(item, role_ids) for item in value]
    if not isinstance(value, dict):
        return value
    if set(value) == {"at"} and isinstance(value["at"], dict) and "role" in value["at"]:
        name = value["at"]["role"]
        return {"at": {"role": role_ids.get(name, name)}}
    match value:
        case {"property": [{"role": name}, reading]} if len(value) == 1:
            return {"property": [{"role": role_ids.get(name, name)}, reading]}
    return {key: with_role_ids(item, role_ids) for key, item in value.items()}
