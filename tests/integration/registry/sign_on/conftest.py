"""A provider that people sign on by, and the settings that let it."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from pytest_django import Settings

from registry.people.sign_on.provider_client import forget_providers
from tests.kit.openid import OpenId, run_openid


@pytest.fixture(scope="module")
def openid(tmp_path_factory: pytest.TempPathFactory) -> Iterator[OpenId]:
    with run_openid(tmp_path_factory.mktemp("openid"), ["http://testserver/sign-on/acme"]) as provider:
        yield provider


@pytest.fixture
def acme(hall: str, openid: OpenId, settings: Settings) -> Iterator[OpenId]:
    forget_providers()
    settings.VIPO_SIGN_ON = [openid.setting()]
    yield openid
    forget_providers()
