#!/bin/sh
# Fetches Debian 13's MicroPython and what it needs, unpacks them without installing anything, and prints the path of
# a launcher that runs it through its own dynamic loader. Done once; later calls only print the path.
#
# usage: scripts/micropython.sh [FOLDER]     (default: $VIPO_STATE_DIR/micropython, or var/micropython)
# On failure: says why on standard error and returns 3. The firmware then runs under CPython.
set -eu

RELEASE=trixie
here=$(CDPATH= cd -- "$(dirname -- "$0")/.." && pwd)
folder=${1:-${VIPO_STATE_DIR:-$here/var}/micropython}
launcher=$folder/micropython

give_up() {
    echo "MicroPython cannot be had: $1" >&2
    exit 3
}

works() { [ -x "$launcher" ] && [ "$("$launcher" -c 'import asyncio, json; print(6 * 7)' 2>/dev/null)" = 42 ]; }

if works; then
    echo "$launcher"
    exit 0
fi

for tool in apt-get apt-cache dpkg-deb dpkg; do
    command -v "$tool" >/dev/null || give_up "this machine has no $tool (it is made for Debian)."
done
[ -r /etc/os-release ] || give_up "this machine does not say which system it is."
# shellcheck disable=SC1091
. /etc/os-release
[ "${ID:-}" = debian ] || give_up "this machine is ${ID:-unknown}, and the package comes through Debian's own sources."

mkdir -p "$folder"
folder=$(CDPATH= cd -- "$folder" && pwd)
launcher=$folder/micropython
work=$(mktemp -d "$folder/fetch.XXXXXX")
trap 'rm -rf "$work"' EXIT
trap 'exit 3' INT TERM HUP
mkdir -p "$work/sources" "$work/lists/partial" "$work/cache/archives/partial" "$work/root" "$work/debs"

# The machine's own sources with the release's name changed; only entries of the release itself, nobody else's.
for file in /etc/apt/sources.list /etc/apt/sources.list.d/*.list /etc/apt/sources.list.d/*.sources; do
    [ -r "$file" ] || continue
    case $file in
    *.sources)
        awk -v old="$VERSION_CODENAME" -v new="$RELEASE" '
            function flush() { if (wanted) printf "%s\n", stanza; stanza = ""; wanted = 0 }
            /^[ \t]*$/ { flush(); next }
            tolower($1) == "suites:" {
                for (i = 2; i <= NF; i++) if ($i == old || $i == new) wanted = 1
                $0 = "Suites: " new
            }
            { stanza = stanza $0 "\n" }
            END { flush() }' "$file" >"$work/sources/$(basename "$file")" ;;
    *)
        awk -v old="$VERSION_CODENAME" -v new="$RELEASE" '
            $1 == "deb" { hit = 0; for (i = 2; i <= NF; i++) if ($i == old || $i == new) { $i = new; hit = 1 }; if (hit) print }
        ' "$file" >"$work/sources/$(basename "$file")" ;;
    esac
done

own_apt() {
    tool=$1
    shift
    "$tool" -qq \
        -o Dir::Etc::sourcelist=/dev/null -o Dir::Etc::sourceparts="$work/sources" \
        -o Dir::State::lists="$work/lists" -o Dir::State::status=/dev/null -o Dir::Cache="$work/cache" \
        -o Acquire::Languages=none -o Acquire::Retries=2 -o APT::Sandbox::User= -o Debug::NoLocking=1 \
        "$@"
}

own_apt apt-get update >"$work/log" 2>&1 || give_up "Debian's list of packages was not reached ($(tail -n 1 "$work/log"))."

packages=$(own_apt apt-cache depends --recurse --no-recommends --no-suggests --no-conflicts --no-breaks --no-replaces \
    --no-enhances micropython 2>>"$work/log" | grep -E '^[a-z0-9]' | sort -u)
[ -n "$packages" ] || give_up "Debian's list has no package micropython."
# shellcheck disable=SC2086
(cd "$work/debs" && own_apt apt-get download $packages) >"$work/log" 2>&1 ||
    give_up "the packages were not fetched ($(tail -n 1 "$work/log"))."
for package in "$work"/debs/*.deb; do
    dpkg-deb -x "$package" "$work/root" || give_up "$(basename "$package") is broken."
done

rm -rf "$folder/root"
mv "$work/root" "$folder/root"
loader=$(find "$folder/root" -name 'ld-linux*.so.*' -type f | head -n 1)
[ -n "$loader" ] || loader=$(find "$folder/root" -name 'ld-linux*.so.*' | head -n 1)
[ -n "$loader" ] || give_up "the C library's loader is not in its package."
machine=$(dpkg-architecture -qDEB_HOST_MULTIARCH 2>/dev/null || basename "$(dirname "$loader")")

cat >"$work/launcher" <<END
#!/bin/sh
# Made by scripts/micropython.sh: Debian's MicroPython with its own C library, from where it was unpacked.
root=\$(CDPATH= cd -- "\$(dirname -- "\$0")/root" && pwd)
exec "\$root/${loader#"$folder/root/"}" --library-path "\$root/usr/lib/$machine:\$root/lib/$machine" "\$root/usr/bin/micropython" "\$@"
END
chmod +x "$work/launcher"
mv "$work/launcher" "$launcher"
works || give_up "it was unpacked but does not run on this machine."
echo "$launcher"
