#!/bin/sh
# Installs what the tests start for themselves: PostgreSQL, Redis, Mosquitto and Chromium, as Debian packages.
# Nothing is enabled or left running by the tests; each test starts its own servers on free ports.
set -eu

missing=""
[ -n "$(find /usr/lib/postgresql -name initdb 2>/dev/null | head -n 1)" ] || missing="$missing postgresql"
command -v redis-server >/dev/null || missing="$missing redis-server"
command -v mosquitto >/dev/null || [ -x /usr/sbin/mosquitto ] || missing="$missing mosquitto"
command -v chromium >/dev/null || missing="$missing chromium"
[ -z "$missing" ] && exit 0

command -v apt-get >/dev/null || {
    echo "The tests need:$missing. This machine has no apt-get; install them by its own means and run this again." >&2
    exit 1
}
as_root=""
if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || {
        echo "The tests need:$missing. Run as root: apt-get install$missing" >&2
        exit 1
    }
    as_root=sudo
fi
echo "Installing for the tests, with apt-get:$missing"
$as_root apt-get update -qq
# shellcheck disable=SC2086
DEBIAN_FRONTEND=noninteractive $as_root apt-get install -y -qq --no-install-recommends $missing >/dev/null
