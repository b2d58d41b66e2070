"""The factsheet of the tests' vehicles, as VDA 5050 2.0 wants it."""

from __future__ import annotations

from typing import Any


def parameter(key: str, kind: str, optional: bool = False) -> dict[str, Any]:
    return {"key": key, "valueDataType": kind, "description": key, "isOptional": optional}


def action(kind: str, scopes: list[str], *parameters: dict[str, Any]) -> dict[str, Any]:
    return {
        "actionType": kind,
        "actionDescription": kind,
        "actionScopes": scopes,
        "actionParameters": list(parameters),
        "resultDescription": "",
    }


HANDLING = (parameter("stationType", "STRING"), parameter("loadType", "STRING"))
FACTSHEET: dict[str, Any] = {
    "typeSpecification": {
        "seriesName": "Carrier 2",
        "seriesDescription": "A virtual vehicle",
        "agvKinematic": "DIFF",
        "agvClass": "CARRIER",
        "maxLoadMass": 500.0,
        "localizationTypes": ["NATURAL"],
        "navigationTypes": ["AUTONOMOUS"],
    },
    "physicalParameters": {
        "speedMin": 0.1,
        "speedMax": 2.0,
        "accelerationMax": 1.0,
        "decelerationMax": 1.0,
        "heightMin": 0.4,
        "heightMax": 1.2,
        "width": 0.6,
        "length": 0.8,
    },
    "protocolLimits": {
        "maxStringLens": {},
        "maxArrayLens": {},
        "timing": {"minOrderInterval": 0.1, "minStateInterval": 0.1},
    },
    "protocolFeatures": {
        "optionalParameters": [],
        "agvActions": [
            action("pick", ["NODE"], *HANDLING),
            action("drop", ["NODE"], *HANDLING),
            action("noop", ["NODE", "INSTANT"], parameter("duration", "FLOAT", True)),
            action("startPause", ["INSTANT"]),
            action("stopPause", ["INSTANT"]),
        ],
    },
    "agvGeometry": {},
    "loadSpecification": {
        "loadPositions": ["deck"],
        "loadSets": [
            {
                "setName": "DEFAULT",
                "loadType": "EPAL",
                "boundingBoxReference": {"x": 0.0, "y": 0.0, "z": 0.3},
                "loadDimensions": {"length": 1.2, "width": 0.8, "height": 1.0},
            }
        ],
    },
}
