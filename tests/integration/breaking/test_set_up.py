"""Setting a site up with `deploy/set-up.sh`, and renewing its secrets, by a user who is not root."""

from __future__ import annotations

import os
import shutil
import subprocess
import tempfile
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.kit.files import ROOT

NOBODY = 65534
AUTHORITY_KEY = Path("secrets") / "authority" / "ca.key"


@pytest.fixture
def site() -> Iterator[Path]:
    """A folder with the script, of a user who is not root."""
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        shutil.copytree(ROOT / "deploy", folder / "deploy")
        if os.geteuid() == 0:
            for path in (folder, *folder.rglob("*")):
                os.chown(path, NOBODY, NOBODY)
        yield folder


def attempt(site: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    command = ["sh", str(site / "deploy" / "set-up.sh"), *arguments]
    other = {"user": NOBODY, "group": NOBODY, "extra_groups": ()} if os.geteuid() == 0 else {}
    return subprocess.run(command, check=False, capture_output=True, text=True, timeout=120, cwd=site, **other)  # type: ignore[call-overload,no-any-return]


def run(site: Path, *arguments: str) -> None:
    done = attempt(site, *arguments)
    assert done.returncode == 0, done.stderr


def kept(site: Path) -> dict[str, str]:
    """Return what every file of the site has, by its path."""
    files = [site / ".env", *(path for path in (site / "secrets").rglob("*") if path.is_file())]
    return {str(path.relative_to(site)): path.read_text() for path in files if path.exists()}


def changed(before: dict[str, str], after: dict[str, str]) -> set[str]:
    return {path for path in before | after if before.get(path) != after.get(path)}


def modes(site: Path) -> set[int]:
    """Return the modes of all files that containers are given."""
    secrets = site / "secrets"
    files = [path for folder in (secrets, secrets / "broker", secrets / "web") for path in folder.iterdir()]
    return {path.stat().st_mode & 0o777 for path in files if path.is_file()}


def names_of(certificate: Path) -> str:
    command = ["openssl", "x509", "-in", str(certificate), "-noout", "-ext", "subjectAltName"]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout.split("\n")[1].strip()


def test_a_renewed_key_comes_before_the_former_ones_and_a_renewed_password_alone(site: Path) -> None:
    run(site, "localhost")
    keys, password = site / "secrets" / "django-key", site / "secrets" / "redis-password"
    first, before = keys.read_text(), password.read_text()
    run(site, "localhost")
    assert keys.read_text() == first
    run(site, "--renew", "django-key")
    run(site, "--renew", "django-key")
    third, second, last = keys.read_text().splitlines(keepends=True)
    assert (last, len({first, second, third}), keys.stat().st_mode & 0o777) == (first, 3, 0o444)
    keys.unlink()
    run(site, "--renew", "django-key")
    assert len(keys.read_text().splitlines()) == 1
    run(site, "--renew", "redis-password")
    assert len(password.read_text().splitlines()) == 1
    assert password.read_text() != before


@pytest.mark.parametrize(
    ("name", "files"),
    [
        ("django-key", {"secrets/django-key"}),
        ("broker-password", {"secrets/broker-password"}),
        ("broker", {"secrets/broker/server.crt", "secrets/broker/server.key"}),
        ("web", {"secrets/web/server.crt", "secrets/web/server.key"}),
    ],
)
def test_whoever_is_not_root_renews_what_they_name_and_containers_can_read_it(
    site: Path, name: str, files: set[str]
) -> None:
    run(site, "localhost")
    before = kept(site)
    run(site, "--renew", name)
    assert (changed(before, kept(site)) - {"secrets/authority/ca.srl"}, modes(site)) == (files, {0o444})


@pytest.mark.parametrize("name", ["broker", "web"])
def test_a_certificate_that_cannot_be_signed_leaves_the_one_that_there_is(site: Path, name: str) -> None:
    run(site, "localhost")
    (site / AUTHORITY_KEY).unlink()
    before = kept(site)
    done = attempt(site, "--renew", name)
    assert (done.returncode, kept(site), modes(site)) == (1, before, {0o444})
    assert "bring it back" in done.stderr


def test_nothing_is_renewed_where_no_name_is_known(site: Path) -> None:
    run(site, "localhost")
    (site / ".env").write_text("VIPO_HOSTS=localhost\n")
    before = kept(site)
    done = attempt(site, "--renew", "redis-password")
    assert (done.returncode, kept(site)) == (1, before)
    assert "VIPO_NAMES" in done.stderr


def test_a_run_that_was_broken_off_is_taken_up(site: Path) -> None:
    run(site, "localhost")
    for name in ("secrets/django-key", "secrets/web/server.key", "secrets/web/server.crt", "secrets/broker/ca.crt"):
        left = site / f"{name}.new"
        left.write_text("half")
        left.chmod(0o444)
        if os.geteuid() == 0:
            os.chown(left, NOBODY, NOBODY)
    (site / "secrets" / "web" / "server.crt").unlink()
    run(site, "--renew", "django-key")
    assert not list((site / "secrets").rglob("*.new"))
    assert "half" not in "".join(kept(site).values())


def test_another_name_is_refused_until_it_is_written_and_signed(site: Path) -> None:
    run(site, "vipo.example.com", "192.0.2.7")
    before = kept(site)
    done = attempt(site, "other.example.com")
    assert (done.returncode, kept(site), "Ready" in done.stdout) == (1, before, False)
    assert "--renew broker" in done.stderr
    settings = (site / ".env").read_text().replace('"vipo.example.com 192.0.2.7"', '"other.example.com"')
    (site / ".env").write_text(settings)
    done = attempt(site, "other.example.com")
    assert (done.returncode, "'other.example.com'" in done.stderr) == (1, True)
    run(site, "--renew", "web")
    run(site, "--renew", "broker")
    run(site, "other.example.com")
    assert names_of(site / "secrets" / "web" / "server.crt") == "DNS:other.example.com"
    assert names_of(site / "secrets" / "broker" / "server.crt") == "DNS:other.example.com, DNS:mosquitto"


def test_an_address_of_version_6_is_one_in_certificates_and_has_brackets_where_a_port_follows(site: Path) -> None:
    run(site, "2001:db8::7", "vipo.example.com")
    run(site, "2001:db8::7", "vipo.example.com")
    wanted = "IP Address:2001:DB8:0:0:0:0:0:7, DNS:vipo.example.com"
    assert names_of(site / "secrets" / "web" / "server.crt") == wanted
    settings = (site / ".env").read_text().splitlines()
    assert "VIPO_HOSTS=[2001:db8::7],vipo.example.com" in settings
    assert "VIPO_BROKER_URL=mqtts://[2001:db8::7]:8883/" in settings
    script = site / "deploy" / "mosquitto" / "make-certificates.sh"
    made = site / "made"
    subprocess.run(["sh", str(script), str(made), "2001:db8::7", "vipo.example.com"], check=True, capture_output=True)
    assert names_of(made / "server.crt") == wanted
