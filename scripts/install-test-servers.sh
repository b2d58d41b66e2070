#!/bin/sh
# Installs what the tests start for themselves, as Debian packages: PostgreSQL, Redis, Mosquitto and its clients,
# nginx, Chromium and ROS 1, and fetches MicroPython into var. Nothing is enabled or left running by the tests; each
# starts its own servers on free ports. ROS and MicroPython are not in every distribution: on Debian the tests that need
# them fail without them, elsewhere they are skipped, and say so.
set -eu

missing=""
[ -n "$(find /usr/lib/postgresql -name initdb 2>/dev/null | head -n 1)" ] || missing="$missing postgresql"
command -v redis-server >/dev/null || missing="$missing redis-server"
command -v mosquitto >/dev/null || [ -x /usr/sbin/mosquitto ] || missing="$missing mosquitto"
command -v mosquitto_pub >/dev/null || missing="$missing mosquitto-clients"
command -v nginx >/dev/null || [ -x /usr/sbin/nginx ] || missing="$missing nginx-light"
command -v chromium-headless-shell >/dev/null || missing="$missing chromium-headless-shell"
ros=""
if ! /usr/bin/python3 -c "import rospy, rosmaster, actionlib, move_base_msgs, nav_msgs, sensor_msgs, paho" 2>/dev/null; then
    ros="python3-rosmaster python3-rospy python3-actionlib python3-move-base-msgs python3-nav-msgs"
    ros="$ros python3-sensor-msgs python3-paho-mqtt"
fi
here=$(CDPATH= cd -- "$(dirname -- "$0")" && pwd)
sh "$here/micropython.sh" "$here/../var/micropython" >/dev/null || true
[ -z "$missing$ros" ] && exit 0

command -v apt-get >/dev/null || {
    [ -z "$missing" ] && exit 0
    echo "The tests need:$missing. This machine has no apt-get; install them by its own means and run this again." >&2
    exit 1
}
as_root=""
if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || {
        [ -z "$missing" ] && exit 0
        echo "The tests need:$missing. Run as root: apt-get install$missing" >&2
        exit 1
    }
    as_root=sudo
fi
install() {
    # shellcheck disable=SC2086
    DEBIAN_FRONTEND=noninteractive $as_root apt-get install -y -qq --no-install-recommends $1 >/dev/null
}
echo "Installing for the tests, with apt-get:$missing $ros"
$as_root apt-get update -qq
[ -z "$missing" ] || install "$missing"
[ -z "$ros" ] || install "$ros" || echo "ROS 1 could not be installed; on Debian the tests that need it will fail." >&2
