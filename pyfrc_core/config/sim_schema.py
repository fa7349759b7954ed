"""The JSON Schema of ``sim/config.json``, with which an editor completes and explains keys."""

from __future__ import annotations

import json

from pydantic.json_schema import GenerateJsonSchema

from .sim import SimConfigFile


def sim_config_schema() -> str:
    """Return the schema as text (JSON Schema, draft 2020-12; ASCII, so that any redirection keeps it).

    With ``"$schema": "config.schema.json"`` at the top of ``sim/config.json``, editors use the file of that name.
    """
    schema = {"$schema": GenerateJsonSchema.schema_dialect, **SimConfigFile.model_json_schema()}
    schema["title"] = "sim/config.json"
    return json.dumps(schema, indent=2)
