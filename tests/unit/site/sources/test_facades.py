"""What other apps may use of an app: its services, keyword by keyword, with frozen views as their results."""

import importlib
import inspect
import re
import tomllib
from collections import Counter
from collections.abc import Iterable
from pathlib import Path
from types import FunctionType
from typing import Any, get_args, get_type_hints

import pytest
from django.contrib.auth.base_user import AbstractBaseUser
from django.db.models import Manager, Model, QuerySet

from tests.kit.files import ROOT

APPS = ("registry", "editor", "simulation", "execution")
PACKAGES = (*APPS, "connectors", "vipo_device", "vipo_site", "bench", "scripts", "tests")
DATABASE = re.compile(r"\.objects\b|_manager\b|\.raw\(|\bcursor\b|\bSELECT\b|\bUPDATE\b")
POSITIONAL = {
    # A view as JSON, or something made of one other thing: there is nothing to mistake.
    "account_file", "alert_to_json", "call_to_json", "device_to_json", "get_walls", "site_to_json",
    # Words that all apps speak with: who may do this, and who is told that.
    "acting", "find_access", "has_ended", "listen", "publish", "publish_all", "require", "session_of_socket",
    "subscribe", "wait_wake", "wake",
}  # fmt: skip
MOST_MODULES = 20


def functions(app: str) -> dict[str, FunctionType]:
    """Return the functions of this product that an app's services give out; cached ones are what they cache."""
    module = importlib.import_module(f"{app}.services")
    named = {name: inspect.unwrap(found) for name, found in vars(module).items() if not name.startswith("_")}
    return {n: f for n, f in named.items() if isinstance(f, FunctionType) and f.__module__.split(".")[0] in APPS}


def parts(annotation: Any) -> set[Any]:
    """Return an annotation with everything in its brackets."""
    inside = [part for part in get_args(annotation) if not isinstance(part, list)]
    return {annotation}.union(*map(parts, inside))


def result_of(function: FunctionType) -> Any:
    """Return what a function gives out; parameters may have types that only the type checker imports."""
    result = FunctionType(function.__code__, function.__globals__)
    result.__annotations__ = {"return": function.__annotations__["return"]}
    return get_type_hints(result)["return"]


def is_row(annotation: Any) -> bool:
    """Tell whether it is of the database; people are, since Django signs in nobody else."""
    rows = (Model, QuerySet, Manager)
    return inspect.isclass(annotation) and issubclass(annotation, rows) and not issubclass(annotation, AbstractBaseUser)


@pytest.mark.parametrize("app", APPS)
def test_services_are_asked_by_keyword(app: str) -> None:
    asked = {name: inspect.signature(function).parameters.values() for name, function in functions(app).items()}
    positional = {name for name, given in asked.items() if any(one.kind is not one.KEYWORD_ONLY for one in given)}
    assert positional - POSITIONAL == set()


@pytest.mark.parametrize("app", APPS)
def test_services_are_annotated_and_give_out_no_rows(app: str) -> None:
    for name, function in functions(app).items():
        assert {*inspect.signature(function).parameters, "return"} <= set(function.__annotations__), name
        assert not [part for part in parts(result_of(function)) if is_row(part)], name


@pytest.mark.parametrize("app", APPS)
def test_services_do_not_speak_to_the_database(app: str) -> None:
    assert DATABASE.findall((ROOT / app / "services.py").read_text()) == []


@pytest.mark.parametrize("app", APPS)
def test_services_give_out_no_sql(app: str) -> None:
    given_out = vars(importlib.import_module(f"{app}.services"))
    assert [name for name, value in given_out.items() if isinstance(value, str) and DATABASE.search(value)] == []


def test_no_app_gets_past_the_borders_by_a_models_name() -> None:
    asks = "get_" + "model("
    sources = [
        path for package in PACKAGES for path in (ROOT / package).rglob("*.py") if path.parent.name != "migrations"
    ]
    assert [str(path.relative_to(ROOT)) for path in sources if asks in path.read_text()] == []


def protected_routes() -> re.Pattern[str]:
    """Return what the modules are called that only the site and the routes of an app may import."""
    contracts = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["importlinter"]["contracts"]
    (found,) = (each for each in contracts if each["name"] == "The site alone mounts routers and sockets")
    of_any = {r"\*\*": r"[\w.]+", r"\*": r"\w+"}
    names = (re.sub(r"\\\*(?:\\\*)?", lambda star: of_any[star[0]], re.escape(n)) for n in found["protected_modules"])
    return re.compile(rf"(?:{'|'.join(names)})(?:\.[\w.]+)?")


def test_each_module_of_routes_is_kept_from_other_apps_by_the_contracts() -> None:
    sources = [path for app in APPS for path in (ROOT / app).rglob("*.py") if "Router(" in path.read_text()]
    modules = [".".join(path.relative_to(ROOT).with_suffix("").parts) for path in sources]
    assert len(modules) > 30
    assert [module for module in modules if not protected_routes().fullmatch(module)] == []
    assert not protected_routes().fullmatch("execution.floor.new_routes")


def crowded(modules: Iterable[Path]) -> dict[str, int]:
    """Return the folders with too many modules, and how many they have."""
    counts = Counter(str(path.parent.relative_to(ROOT)) for path in modules)
    return {folder: count for folder, count in sorted(counts.items()) if count > MOST_MODULES}


@pytest.mark.parametrize(
    "package",
    PACKAGES,
)
def test_no_folder_has_more_modules_than_one_looks_through(package: str) -> None:
    modules = [path for path in (ROOT / package).rglob("*.py") if path.name != "__init__.py"]
    aside = ("migrations", "tests/cases")
    assert crowded(path for path in modules if not path.parent.as_posix().endswith(aside)) == {}


def test_no_folder_of_the_pages_has_more_modules_than_one_looks_through() -> None:
    modules = [path for kind in ("ts", "tsx") for path in (ROOT / "frontend" / "src").rglob(f"*.{kind}")]
    assert crowded(path for path in modules if ".test." not in path.name) == {}


def test_the_image_has_every_package_of_the_product() -> None:
    copied = [line.split()[1] for line in (ROOT / "Dockerfile").read_text().splitlines() if line.startswith("COPY ")]
    assert {*APPS, "connectors", "vipo_device", "vipo_site"} <= set(copied)
