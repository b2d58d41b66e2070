"""The product's own settings, with a state folder of this process's own; the programs that it starts share it."""

import atexit
import os
import shutil
import tempfile

worker = os.environ.get("PYTEST_XDIST_WORKER", "")
if "VIPO_STATE_DIR" not in os.environ or os.environ.get("VIPO_TEST_WORKER", worker) != worker:
    folder = tempfile.mkdtemp(prefix="vipo-tests-")
    os.environ |= {"VIPO_STATE_DIR": folder, "VIPO_TEST_WORKER": worker}
    atexit.register(shutil.rmtree, folder, ignore_errors=True)

from vipo_site.settings import *  # noqa: E402, F403

DATABASES["default"]["TEST"] = {"NAME": str(VIPO_STATE_DIR / "tests.sqlite3")}  # noqa: F405
PASSWORD_HASHERS = ["django.contrib.auth.hashers.MD5PasswordHasher"]
