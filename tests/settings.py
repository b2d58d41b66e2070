"""The product's own settings, with a state folder of this test session's own."""

import atexit
import os
import shutil
import tempfile

if "VIPO_STATE_DIR" not in os.environ:
    folder = tempfile.mkdtemp(prefix="vipo-tests-")
    os.environ["VIPO_STATE_DIR"] = folder
    atexit.register(shutil.rmtree, folder, ignore_errors=True)

from vipo_site.settings import *  # noqa: F403

PASSWORD_HASHERS = ["django.contrib.auth.hashers.MD5PasswordHasher"]
