"""How settings are read: from the environment, from files that it names, and what about them stops a start."""

from __future__ import annotations

import os
import re
import secrets
from ipaddress import IPv4Network, IPv6Network, ip_network
from pathlib import Path
from urllib.parse import quote, urlsplit

from django.core.exceptions import ImproperlyConfigured

LEAST_SECRET = 12
"""So many characters a secret of a served site has at least, of which LEAST_DIFFERENT differ."""
LEAST_DIFFERENT = 5
LEAST_KEY = 32
WIDEST_PROXIES = {4: 8, 6: 32}
"""The shortest prefix of a network of proxies; whoever names a wider one has named strangers."""
LOG_LEVELS = ("DEBUG", "INFO", "WARNING", "ERROR", "CRITICAL")
LOG_FORMS = ("json", "text")

FACTOR_ROLES = ("commenter", "operator", "author", "admin")
_PROVIDER = re.compile(r"[a-z0-9][a-z0-9-]{0,19}")

Network = IPv4Network | IPv6Network


def required(name: str) -> str:
    """Return a setting that the served mode cannot do without."""
    value = os.environ.get(name, "")
    if not value:
        raise ImproperlyConfigured(f"{name} is not set; the served mode needs it (see docs/operations.md).")
    return value


def secret(name: str) -> str:
    """Return a secret: the setting itself, or what is in the file that the setting NAME_FILE names; empty for none."""
    path = os.environ.get(f"{name}_FILE", "")
    if not path:
        return os.environ.get(name, "")
    if os.environ.get(name):
        raise ImproperlyConfigured(f"{name} and {name}_FILE are both set; keep the file and take the other away.")
    try:
        return Path(path).read_text().strip()
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or "it is no text"
        raise ImproperlyConfigured(f"{name}_FILE names {path}, which cannot be read: {reason}.") from error


def required_secret(name: str, least: int = LEAST_SECRET) -> str:
    """Return a secret that is long enough not to be guessed."""
    value = secret(name) or required(name)
    _check_secret(name, value, least)
    return value


def signing_keys(name: str) -> list[str]:
    """Return the key that signs, and those before it, each in a line of its own: what these sealed is still read."""
    keys = lines_of(secret(name) or required(name)) or [""]  # a secret of blanks is one that can be guessed
    for key in keys:
        _check_secret(name, key, LEAST_KEY)
    return keys


def lines_of(text: str) -> list[str]:
    """Return the lines of a text that say something."""
    return [line.strip() for line in text.splitlines() if line.strip()]


def _check_secret(name: str, value: str, least: int) -> None:
    if len(value) < least or len(set(value)) < LEAST_DIFFERENT:
        raise ImproperlyConfigured(f"{name} can be guessed: take {least} random characters at least.")


def with_password(name: str) -> str:
    """Return the URL of a server, NAME_URL, with the password of NAME_PASSWORD; one elsewhere must have some."""
    url, password = required(f"{name}_URL"), secret(f"{name}_PASSWORD")
    parts = urlsplit(url)
    if password and not parts.password:
        place = parts.netloc.rpartition("@")[2]
        url = parts._replace(
            netloc=f"{quote(parts.username or '', safe='')}:{quote(password, safe='')}@{place}"
        ).geturl()
    elif not password and not parts.password and not is_local(parts.hostname or "localhost"):
        raise ImproperlyConfigured(
            f"{name}_PASSWORD is not set, and {name}_URL names another machine without a password: "
            "whoever reaches it may do everything."
        )
    return url


def is_local(host: str) -> bool:
    """Tell whether a host's name, perhaps with a port, can mean this machine only."""
    is_bare_ipv6 = host.count(":") > 1 and not host.startswith("[")
    name = host.lower() if is_bare_ipv6 else urlsplit(f"//{host}").hostname or ""
    try:
        return bool(ip_network(name).is_loopback)
    except ValueError:
        return name == "localhost" or name.endswith(".localhost")


def served_hosts(default: str) -> list[str]:
    """Return the names under which browsers may ask; a pattern for all names is refused."""
    hosts = [host.strip() for host in (os.environ.get("VIPO_HOSTS", "") or default).split(",") if host.strip()]
    if any(host == "*" or host.startswith(".") for host in hosts):
        raise ImproperlyConfigured("VIPO_HOSTS is unsafe: name each host, without '*' and without a dot before it.")
    return hosts


def is_https(hosts: list[str], *, served: bool) -> bool:
    """Tell whether browsers come by https; a served site that others reach does nothing else."""
    value = os.environ.get("VIPO_HTTPS", "1" if served else "0")
    if value not in {"0", "1"}:
        raise ImproperlyConfigured(f"VIPO_HTTPS is {value[:20]!r}; set it to 1, or to 0 for this machine alone.")
    if served and value == "0" and not all(map(is_local, hosts)):
        raise ImproperlyConfigured(
            "VIPO_HTTPS is 0 and VIPO_HOSTS names other machines' way here: passwords would travel where others read "
            "them. Set VIPO_HTTPS=1 and a proxy with TLS before the web processes."
        )
    return value == "1"


def named_proxies(*, https: bool) -> tuple[Network, ...]:
    """Return the addresses and networks whose word on a request's origin is believed, from VIPO_PROXIES."""
    named = [part.strip() for part in os.environ.get("VIPO_PROXIES", "").split(",") if part.strip()]
    if https and not named:
        raise ImproperlyConfigured(
            "VIPO_PROXIES is not set; with VIPO_HTTPS=1 it names the addresses of the proxy that ends TLS."
        )
    try:
        networks = tuple(ip_network(part) for part in named)
    except ValueError as error:
        raise ImproperlyConfigured(f"VIPO_PROXIES is no list of addresses and networks: {error}.") from error
    if wide := [str(network) for network in networks if network.prefixlen < WIDEST_PROXIES[network.version]]:
        raise ImproperlyConfigured(f"VIPO_PROXIES is unsafe: {wide[0]} holds strangers, too. Name the proxy alone.")
    return networks


def has_demo(hosts: list[str]) -> bool:
    """Tell whether the painting factory and its accounts are wanted; never where others than this machine get in."""
    if os.environ.get("VIPO_DEMO", "") != "1":
        return False
    if foreign := [host for host in hosts if not is_local(host)]:
        raise ImproperlyConfigured(
            f"VIPO_DEMO=1 makes accounts whose passwords are shown, and VIPO_HOSTS names {foreign[0][:100]!r}: it is "
            "for localhost and 127.0.0.1 alone. Set VIPO_DEMO=0; `vipo account` makes accounts for people."
        )
    return True


def log_words() -> tuple[str, str]:
    """Return from which level on is logged, and in which form, from VIPO_LOG: `INFO`, `json`, or both with a comma."""
    level, form = "WARNING", "text"
    for word in filter(None, (part.strip() for part in os.environ.get("VIPO_LOG", "").split(","))):
        if word in LOG_FORMS:
            form = word
        elif word in LOG_LEVELS:
            level = word
        else:
            known = ", ".join((*LOG_LEVELS, *LOG_FORMS))
            raise ImproperlyConfigured(f"VIPO_LOG has {word[:20]!r}; it names a level, a form or both, of {known}.")
    return level, form


def mail_tls() -> str:
    """Return how the way to the mail server is kept from others, from VIPO_MAIL_TLS: `starttls`, `tls` or `none`."""
    value = os.environ.get("VIPO_MAIL_TLS", "") or "starttls"
    if value not in ("starttls", "tls", "none"):
        raise ImproperlyConfigured(f"VIPO_MAIL_TLS is {value[:20]!r}; set it to starttls, tls or none.")
    host = os.environ.get("VIPO_MAIL_HOST", "")
    if value == "none" and host and not is_local(host):
        raise ImproperlyConfigured(
            "VIPO_MAIL_TLS is none and VIPO_MAIL_HOST another machine: invitations would travel where others read "
            "them. Set VIPO_MAIL_TLS=starttls or tls."
        )
    return value


def mail_sender(host: str) -> str:
    """Return from whom mail comes, VIPO_MAIL_FROM, which a server that sends any must say."""
    sender = os.environ.get("VIPO_MAIL_FROM", "")
    if host and not sender:
        raise ImproperlyConfigured("VIPO_MAIL_FROM is not set; with VIPO_MAIL_HOST it names the sender of mail.")
    return sender or "vipo@localhost"


def sign_on_providers(*, with_secrets: bool) -> list[dict[str, object]]:
    """Return whom people may sign in by (OpenID Connect), in the order of VIPO_SIGN_ON; each has settings by its name.

    What signs nobody in is not told their secrets. docs/operations.md has the settings.
    """
    names = [name.strip() for name in os.environ.get("VIPO_SIGN_ON", "").split(",") if name.strip()]
    for name in names:
        if not _PROVIDER.fullmatch(name) or names.count(name) > 1:
            raise ImproperlyConfigured(
                f"VIPO_SIGN_ON has {name[:40]!r}; it names providers, each once, in 1 to 20 small letters, digits, -."
            )
    return [_provider(name, with_secrets=with_secrets) for name in names]


def _provider(name: str, *, with_secrets: bool) -> dict[str, object]:
    setting = f"VIPO_SIGN_ON_{name.upper().replace('-', '_')}"
    for needed in ("ISSUER", "CLIENT_ID"):
        if not os.environ.get(f"{setting}_{needed}"):
            raise ImproperlyConfigured(
                f"{setting}_{needed} is not set; VIPO_SIGN_ON names {name} (docs/operations.md)."
            )
    issuer = os.environ[f"{setting}_ISSUER"]
    parts = urlsplit(issuer)
    if parts.scheme != "https" and not (parts.scheme == "http" and is_local(parts.netloc)):
        raise ImproperlyConfigured(f"{setting}_ISSUER is unsafe: {issuer[:100]!r} has to begin with https://.")
    if parts.query or parts.fragment or parts.username:
        raise ImproperlyConfigured(f"{setting}_ISSUER is no issuer: it has neither a query, a # nor a user's name.")
    key = secret(f"{setting}_CLIENT_SECRET") if with_secrets else "-"
    if not key:
        raise ImproperlyConfigured(
            f"{setting}_CLIENT_SECRET is not set; VIPO_SIGN_ON names {name}. A file may hold it: "
            f"{setting}_CLIENT_SECRET_FILE."
        )
    domains = [word.lower().lstrip("@") for word in _words(f"{setting}_DOMAINS")]
    if bad := [domain for domain in domains if "." not in domain or "*" in domain]:
        raise ImproperlyConfigured(
            f"{setting}_DOMAINS has {bad[0][:60]!r}; name whole mail domains, as in example.com."
        )
    return {
        "name": name,
        "title": os.environ.get(f"{setting}_TITLE", "")[:40] or name,
        "issuer": issuer,
        "client_id": os.environ[f"{setting}_CLIENT_ID"],
        "client_secret": key,
        "links_by_email": _switch(f"{setting}_LINK"),
        "domains": domains,
        "amr": _words(f"{setting}_AMR"),
        "acr": _words(f"{setting}_ACR"),
        "signs_out": _switch(f"{setting}_SIGN_OUT"),
    }


def demanded_factor() -> str:
    """Return the least role of which every site demands a second factor, from VIPO_SECOND_FACTOR; empty for none."""
    value = os.environ.get("VIPO_SECOND_FACTOR", "")
    if value and value not in FACTOR_ROLES:
        raise ImproperlyConfigured(f"VIPO_SECOND_FACTOR is {value[:20]!r}; it names one of {', '.join(FACTOR_ROLES)}.")
    return value


def _words(name: str) -> list[str]:
    return [word.strip() for word in os.environ.get(name, "").split(",") if word.strip()]


def _switch(name: str) -> bool:
    value = os.environ.get(name, "") or "0"
    if value not in {"0", "1"}:
        raise ImproperlyConfigured(f"{name} is {value[:20]!r}; set it to 1 or 0.")
    return value == "1"


def whole_number(name: str, default: int, least: int = 1) -> int:
    """Return a setting that counts something; nonsense and what is below the least stop the start."""
    value = os.environ.get(name, "") or str(default)
    if not value.isdecimal() or int(value) < least:
        raise ImproperlyConfigured(f"{name} is {value[:20]!r}; set it to a whole number of at least {least}.")
    return int(value)


def open_state(folder: Path) -> None:
    """Make the folder of VIPO's files, or take from others the right to look into it."""
    folder.mkdir(parents=True, exist_ok=True, mode=0o700)
    keep_private(folder, 0o700)


def keep_private(path: Path, mode: int) -> None:
    """Take from everybody but its owner what they may do with a file; another's file is another's to keep."""
    known = path.stat()
    if known.st_mode & 0o077 and known.st_uid == os.geteuid():
        path.chmod(mode)


def private_database(path: Path) -> Path:
    """Return the path of SQLite's file, readable for its owner alone; SQLite gives -wal and -shm the same mode."""
    path.touch(mode=0o600)
    for file in (path, path.with_name(f"{path.name}-wal"), path.with_name(f"{path.name}-shm")):
        if file.exists():
            keep_private(file, 0o600)
    return path


def local_secret(folder: Path, name: str) -> str:
    """Return a secret of this machine, made at first use and kept beside the database."""
    path = folder / "secrets" / name
    if not path.exists():
        path.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
        path.touch(mode=0o600)
        path.write_text(secrets.token_urlsafe(32))
    return path.read_text().strip()
