"""All settings, from the environment. The one place that knows which of the two modes runs."""

from __future__ import annotations

import os
import secrets
import socket
from pathlib import Path
from urllib.parse import unquote, urlsplit

from django.core.exceptions import ImproperlyConfigured

from vipo_site.environment import (
    demanded_factor,
    has_demo,
    is_https,
    is_local,
    lines_of,
    local_secret,
    log_words,
    mail_sender,
    mail_tls,
    named_proxies,
    open_state,
    private_database,
    required,
    required_secret,
    secret,
    served_hosts,
    sign_on_providers,
    signing_keys,
    whole_number,
    with_password,
)

BASE_DIR = Path(__file__).resolve().parent.parent
MODE = os.environ.get("VIPO_MODE", "embedded")
if MODE not in {"embedded", "served"}:
    raise ImproperlyConfigured(f"VIPO_MODE is {MODE!r}; set it to 'embedded' or 'served'.")
SERVED = MODE == "served"

VIPO_STATE_DIR = Path(os.environ.get("VIPO_STATE_DIR", BASE_DIR / "var"))

if not SERVED:
    open_state(VIPO_STATE_DIR)

VIPO_PROCESS = os.environ.get("VIPO_PROCESS", "")
"""What runs here where a process is not to see every secret: web, gateway, worker, ticker, mirror, stand-ins,
twin, connector."""
_PROCESSES = ("web", "gateway", "worker", "ticker", "mirror", "stand-ins", "twin", "connector")
if VIPO_PROCESS not in {"", *_PROCESSES}:
    raise ImproperlyConfigured(f"VIPO_PROCESS is {VIPO_PROCESS!r}; it names {', '.join(_PROCESSES)}.")
_SIGNS = VIPO_PROCESS in {"", "web"}
_SPEAKS_FOR_VIPO = VIPO_PROCESS in {"", "web", "gateway", "mirror", "stand-ins"}
if SERVED:
    # What signs nothing has a key of its own: what it signed by mistake would be worth nothing elsewhere.
    _KEYS = signing_keys("VIPO_SECRET_KEY") if _SIGNS else [secrets.token_urlsafe(32)]
else:
    _KEYS = lines_of(local_secret(VIPO_STATE_DIR, "django"))
SECRET_KEY, *VIPO_FORMER_KEYS = _KEYS
"""Former keys are none of Django's fallbacks: what they signed is worth nothing, and sessions end with a new key. They
read the second factors and enrolment keys that were sealed with them."""
DEBUG = False
ALLOWED_HOSTS = served_hosts(required("VIPO_HOSTS") if SERVED else "127.0.0.1,localhost,[::1]")
CSRF_TRUSTED_ORIGINS = [o for o in os.environ.get("VIPO_ORIGINS", "").split(",") if o]
SESSION_COOKIE_SECURE = CSRF_COOKIE_SECURE = is_https(ALLOWED_HOSTS, served=SERVED)
VIPO_PROXIES = named_proxies(https=SESSION_COOKIE_SECURE)
SECURE_HSTS_SECONDS = 365 * 24 * 3600 if SESSION_COOKIE_SECURE else 0

INSTALLED_APPS = [
    "channels",
    "django.contrib.auth",
    "django.contrib.contenttypes",
    "django.contrib.sessions",
    "django.contrib.staticfiles",
    "registry",
    "editor",
    "simulation",
    "connectors",
    "execution",
    "vipo_site",
]
MIDDLEWARE = [
    "vipo_site.http.observation.Observed",
    "django.middleware.security.SecurityMiddleware",
    "vipo_site.http.middleware.SecurityHeaders",
    "vipo_site.http.middleware.Compress",
    "vipo_site.http.middleware.TellUnchanged",
    "vipo_site.http.middleware.TellMethods",
    "vipo_site.http.middleware.FitTexts",
    "vipo_site.http.sessions.Sessions",
    "django.middleware.common.CommonMiddleware",
    "django.middleware.csrf.CsrfViewMiddleware",
    "django.contrib.auth.middleware.AuthenticationMiddleware",
    "vipo_site.http.actor_middleware.ActorMiddleware",
    "django.middleware.clickjacking.XFrameOptionsMiddleware",
]
ROOT_URLCONF = "vipo_site.urls"
ASGI_APPLICATION = "vipo_site.asgi.application"
TEMPLATES: list[dict[str, object]] = []
AUTH_USER_MODEL = "registry.User"
DEFAULT_AUTO_FIELD = "django.db.models.BigAutoField"
AUTH_PASSWORD_VALIDATORS = [
    {"NAME": f"django.contrib.auth.password_validation.{name}", "OPTIONS": options}
    for name, options in (
        ("MinimumLengthValidator", {"min_length": 10}),
        ("CommonPasswordValidator", {}),
        ("NumericPasswordValidator", {}),
        ("UserAttributeSimilarityValidator", {"user_attributes": ("email", "display_name")}),
    )
]
LANGUAGE_CODE = "en"
TIME_ZONE = os.environ.get("VIPO_TIME_ZONE", "UTC")
USE_TZ = True
SESSION_COOKIE_HTTPONLY = True
SESSION_COOKIE_SAMESITE = "Lax"


FROZEN_AFTER_S = float(os.environ.get("VIPO_DATABASE_IDLE_S", "15"))
"""PostgreSQL ends a transaction in which nothing has been asked for so long: a frozen process holds up nobody."""
_LIMITS_S = {"web": (30, 10), "gateway": (15, 5), "worker": (60, 10), "ticker": (120, 10)}
_STATEMENT_S, _LOCK_S = _LIMITS_S.get(VIPO_PROCESS, (60, 10) if VIPO_PROCESS else (0, 60))
STATEMENT_LIMIT_S = float(os.environ.get("VIPO_DATABASE_STATEMENT_S", _STATEMENT_S))
"""PostgreSQL ends a statement that takes so long, 0: none. A process without a name may be one that migrates."""
LOCK_LIMIT_S = float(os.environ.get("VIPO_DATABASE_LOCK_S", _LOCK_S))
"""And one that waits so long for what another holds."""
SILENT_S = 30
"""A connection whose other end does not answer for so long is given up by both ends."""


def postgres(url: str) -> dict[str, object]:
    """Turn postgresql://user:password@host:port/name into Django's form."""
    parts = urlsplit(url)
    return {
        "ENGINE": "django.db.backends.postgresql",
        "NAME": parts.path.lstrip("/"),
        "USER": unquote(parts.username or ""),
        "PASSWORD": unquote(parts.password or ""),
        "HOST": parts.hostname or "",
        "PORT": str(parts.port or ""),
        "CONN_MAX_AGE": 0,
        "OPTIONS": {
            "options": " ".join(f"-c {name}={value}" for name, value in _session_limits().items()),
            "application_name": f"vipo {VIPO_PROCESS}".rstrip(),
            "connect_timeout": 10,
            "keepalives_idle": SILENT_S // 3,
            "keepalives_interval": SILENT_S // 6,
            "keepalives_count": 4,
            "tcp_user_timeout": SILENT_S * 1000,
        },
    }


def _session_limits() -> dict[str, int]:
    """Return what PostgreSQL is asked to hold to for each connection; times in ms, of keepalives in s."""
    return {
        "idle_in_transaction_session_timeout": round(FROZEN_AFTER_S * 1000),
        "statement_timeout": round(STATEMENT_LIMIT_S * 1000),
        "lock_timeout": round(LOCK_LIMIT_S * 1000),
        "tcp_keepalives_idle": SILENT_S // 3,
        "tcp_keepalives_interval": SILENT_S // 6,
        "tcp_keepalives_count": 4,
        "tcp_user_timeout": SILENT_S * 1000,
    }


if SERVED:
    DATABASES = {"default": postgres(with_password("VIPO_DATABASE"))}
else:
    DATABASES = {
        "default": {
            "ENGINE": "django.db.backends.sqlite3",
            "NAME": private_database(VIPO_STATE_DIR / "vipo.sqlite3"),
            "OPTIONS": {
                "transaction_mode": "IMMEDIATE",
                "timeout": 20,
                "init_command": "PRAGMA journal_mode=WAL; PRAGMA synchronous=NORMAL;",
            },
        }
    }

VIPO_REDIS_URL = with_password("VIPO_REDIS") if SERVED else None
VIPO_LIVE_URL = VIPO_REDIS_URL or "memory://"
VIPO_STREAM_URL = VIPO_REDIS_URL or "memory://"


def _mqtt_password() -> str:
    """Return the server's password at the broker; what never speaks for VIPO there has none."""
    if not SERVED:
        return local_secret(VIPO_STATE_DIR, "mqtt-server")
    return required_secret("VIPO_MQTT_PASSWORD") if _SPEAKS_FOR_VIPO else ""


VIPO_MQTT = {
    "host": required("VIPO_MQTT_HOST") if SERVED else "127.0.0.1",
    "port": int(os.environ.get("VIPO_MQTT_PORT", "8883" if SERVED else "1883")),
    "username": os.environ.get("VIPO_MQTT_USERNAME", "server"),
    "password": _mqtt_password(),
    "tls": os.environ.get("VIPO_MQTT_TLS", "1" if SERVED else "0") == "1",
    "ca": os.environ.get("VIPO_MQTT_CA", ""),
    "protocol": "auto" if SERVED else "3.1.1",
}
if SERVED and not VIPO_MQTT["tls"] and not is_local(str(VIPO_MQTT["host"])):
    raise ImproperlyConfigured("VIPO_MQTT_TLS is 0 and VIPO_MQTT_HOST another machine: set VIPO_MQTT_TLS=1.")
VIPO_BROKER_ACCOUNTS = f"registry.broker.accounts.{'DynamicSecurity' if SERVED else 'AskedAccounts'}"
VIPO_GATEWAY = f"gateway-{os.environ.get('VIPO_GATEWAY') or socket.gethostname()}"
"""What the broker knows a gateway by; two on one machine need names of their own."""
VIPO_BROKER_URL = os.environ.get("VIPO_BROKER_URL", "" if SERVED else f"mqtt://127.0.0.1:{VIPO_MQTT['port']}/")
VIPO_DEFAULT_SITE = os.environ.get("VIPO_DEFAULT_SITE", "painting-factory")
VIPO_OFFLINE_ALERT_S = float(os.environ.get("VIPO_OFFLINE_ALERT_S", "600"))
"""After so many seconds a device that is away is worth an alert; one that is needed for work is at once."""
VIPO_PULSE = os.environ.get("VIPO_PULSE", "")
"""The file that a process without pages touches while it works, for a health check; none if empty."""
VIPO_SPEED = float(os.environ.get("VIPO_SPEED", "1"))
VIPO_REHEARSALS_AT_ONCE = whole_number("VIPO_REHEARSALS_AT_ONCE", os.cpu_count() or 1)
"""So many rehearsals are under way on a machine at a time, over all workers there."""
VIPO_REHEARSALS_OF_PERSON = whole_number("VIPO_REHEARSALS_OF_PERSON", 5)
VIPO_REHEARSALS_OF_SITE = whole_number("VIPO_REHEARSALS_OF_SITE", 20)
"""So many of one person, and of a site, may wait or be under way."""
VIPO_REHEARSAL_LIMIT_S = whole_number("VIPO_REHEARSAL_LIMIT_S", 600)
"""After so many seconds by the clock a rehearsal is ended."""
VIPO_REHEARSAL_MEMORY_MB = whole_number("VIPO_REHEARSAL_MEMORY_MB", 2048, least=512)
"""So much memory the process of a rehearsal may ask for."""
VIPO_KEEP_RUNS_DAYS = whole_number("VIPO_KEEP_RUNS_DAYS", 365, least=0)
VIPO_KEEP_REHEARSALS_DAYS = whole_number("VIPO_KEEP_REHEARSALS_DAYS", 30, least=0)
VIPO_KEEP_CALLS_DAYS = whole_number("VIPO_KEEP_CALLS_DAYS", 365, least=0)
"""For so many days what has ended stays in the database, 0: for ever; each site may choose others."""
VIPO_ARCHIVE_DIR = Path(os.environ.get("VIPO_ARCHIVE_DIR", VIPO_STATE_DIR / "archive"))
"""Where what is older lies as files; the workers of upkeep write it, the web processes read it."""
VIPO_AUDIT_DAYS = whole_number("VIPO_AUDIT_DAYS", 730, least=30)
"""For so many days the record of what was done at each site is kept."""

EMAIL_HOST = os.environ.get("VIPO_MAIL_HOST", "")
"""The server that takes mail; without one invitations are links alone."""
_MAIL_TLS = mail_tls()
EMAIL_USE_TLS, EMAIL_USE_SSL = _MAIL_TLS == "starttls", _MAIL_TLS == "tls"
EMAIL_PORT = whole_number("VIPO_MAIL_PORT", {"starttls": 587, "tls": 465, "none": 25}[_MAIL_TLS])
EMAIL_HOST_USER = os.environ.get("VIPO_MAIL_USER", "")
EMAIL_HOST_PASSWORD = secret("VIPO_MAIL_PASSWORD") if EMAIL_HOST and VIPO_PROCESS in {"", "web", "worker"} else ""
EMAIL_TIMEOUT = 10
DEFAULT_FROM_EMAIL = mail_sender(EMAIL_HOST)

VIPO_SECOND_FACTOR = demanded_factor()
"""The least role of which every site demands a second factor; a site may demand it of more."""
VIPO_SIGN_ON = sign_on_providers(with_secrets=_SIGNS)
"""Whom people may sign in by beside passwords, by OpenID Connect."""
AUTHENTICATION_BACKENDS = ["django.contrib.auth.backends.ModelBackend", "registry.people.backends.TwoFactors"]
"""Passwords; and the mark of a session whose provider vouched for a second factor."""

VIPO_DEMO = has_demo(ALLOWED_HOSTS)
VIPO_DEMO_SIGN_IN = VIPO_DEMO and not SERVED
"""Whether the sign-in page offers the demo's accounts, which tells their passwords to who asks."""

CELERY_BROKER_URL = VIPO_REDIS_URL or "memory://localhost/"
CELERY_BROKER_TRANSPORT_OPTIONS: dict[str, object] = {} if SERVED else {"polling_interval": 0.02}
CELERY_TASK_DEFAULT_QUEUE = "upkeep"
CELERY_TASK_ROUTES = {
    **{f"execution.tasks.{name}": {"queue": "runs"} for name in ("advance_run", "advance_site", "drive_site")},
    "execution.tasks.rehearse": {"queue": "rehearsals"},
}
"""Runs have workers that do nothing else. Those of rehearsals have threads to spare, which do the upkeep."""
CELERY_WORKER_POOL = "threads"  # what child processes count would not go out with the worker's heartbeat
CELERY_WORKER_CONCURRENCY = VIPO_REHEARSALS_AT_ONCE + 2
CELERY_TASK_IGNORE_RESULT = True
CELERY_TASK_ACKS_LATE = False
CELERY_WORKER_HIJACK_ROOT_LOGGER = False
CELERY_WORKER_REDIRECT_STDOUTS = False
CELERY_BROKER_CONNECTION_RETRY_ON_STARTUP = True
CELERY_TIMEZONE = "UTC"

FRONTEND_DIST = Path(os.environ.get("VIPO_FRONTEND_DIST", BASE_DIR / "frontend" / "dist"))
STATIC_URL = "/static/"
STATIC_ROOT = VIPO_STATE_DIR / "static"
DATA_UPLOAD_MAX_MEMORY_SIZE = 4 * 1024 * 1024
FILE_UPLOAD_MAX_MEMORY_SIZE = 16 * 1024 * 1024

VIPO_METRICS_TOKEN = required_secret("VIPO_METRICS_TOKEN") if secret("VIPO_METRICS_TOKEN") else ""
"""Who shows it may read /metrics; without one only this machine may."""

_LOG_LEVEL, _LOG_FORM = log_words()
_LINES = {
    "json": {"()": "vipo_site.logs.JsonLines", "process": VIPO_PROCESS},
    "text": {"()": "vipo_site.logs.TextLines"},
}
LOGGING = {
    "version": 1,
    "disable_existing_loggers": False,
    "formatters": {"line": _LINES[_LOG_FORM]},
    "handlers": {"stderr": {"class": "logging.StreamHandler", "formatter": "line"}},
    "root": {"handlers": ["stderr"], "level": _LOG_LEVEL},
}
