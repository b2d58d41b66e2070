#!/bin/sh
# Makes what a site needs before its first start: secrets, certificates, and .env with the site's name.
# usage: deploy/set-up.sh NAME [NAME ...]   (names and addresses of this server; browsers use the first one)
#        deploy/set-up.sh --renew SECRET    (django-key, redis-password, broker-password, broker or web)
# What is there already is left alone. The folder secrets/ is for its owner only; the containers see single files of it.
set -eu
cd "$(dirname "$0")/.."
umask 077
mkdir -p secrets/authority secrets/broker secrets/web
chmod 700 secrets

if [ "${1:-}" = --renew ]; then
    case ${2:-} in
    django-key) # the former keys stay in further lines: they read what was sealed with them, and sign nothing
        { openssl rand -hex 32 && if [ -e secrets/django-key ]; then cat secrets/django-key; fi; } >secrets/django-key.new
        mv -f secrets/django-key.new secrets/django-key
        ;;
    redis-password | broker-password) rm -f "secrets/$2" ;;
    broker | web) rm -f "secrets/$2/server.crt" "secrets/$2/server.key" ;;
    *)
        echo "usage: deploy/set-up.sh --renew django-key|redis-password|broker-password|broker|web" >&2
        exit 2
        ;;
    esac
    names=$(sed -n 's/^VIPO_NAMES="\{0,1\}\([^"]*\)"\{0,1\}$/\1/p' .env)
    # shellcheck disable=SC2086
    set -- $names
fi
[ "$#" -gt 0 ] || {
    echo "usage: deploy/set-up.sh NAME [NAME ...]   such as: deploy/set-up.sh vipo.example.com 192.0.2.7" >&2
    exit 2
}
for name in "$@"; do
    case $name in
    *[!A-Za-z0-9.:-]* | -* | '')
        echo "'$name' is no name and no address of a server." >&2
        exit 2
        ;;
    esac
done

for secret in django-key database-password redis-password broker-password; do
    # The file is readable in the containers that it is given to, whoever they run as; nobody else gets to it, for the
    # folder above is closed.
    [ -s "secrets/$secret" ] || openssl rand -hex 32 >"secrets/$secret"
    chmod 444 "secrets/$secret"
done

authority() {
    [ -s secrets/authority/ca.crt ] && return
    openssl req -x509 -newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -nodes -days 3650 -subj "/CN=VIPO of $1" \
        -addext basicConstraints=critical,CA:TRUE -addext keyUsage=critical,keyCertSign,cRLSign \
        -keyout secrets/authority/ca.key -out secrets/authority/ca.crt 2>/dev/null
}

certificate() { # FOLDER NAME ...
    folder=secrets/$1
    shift
    [ -s "$folder/server.crt" ] && return
    [ -s secrets/authority/ca.key ] || {
        echo "secrets/authority/ca.key is not here; bring it back to sign $folder/server.crt, then take it away." >&2
        exit 1
    }
    names=""
    for name in "$@"; do
        case $name in
        *:*) names="$names,IP:$name" ;;
        *[!0-9.]*) names="$names,DNS:$name" ;;
        *) names="$names,IP:$name" ;;
        esac
    done
    openssl req -newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -nodes -subj "/CN=$1" \
        -keyout "$folder/server.key" -out "$folder/server.csr" 2>/dev/null
    printf 'subjectAltName=%s\nbasicConstraints=CA:FALSE\nkeyUsage=digitalSignature\nextendedKeyUsage=serverAuth\n' \
        "${names#,}" >"$folder/server.ext"
    openssl x509 -req -in "$folder/server.csr" -CA secrets/authority/ca.crt -CAkey secrets/authority/ca.key \
        -CAcreateserial -days 825 -sha256 -extfile "$folder/server.ext" -out "$folder/server.crt" 2>/dev/null
    rm "$folder/server.csr" "$folder/server.ext"
}

authority "$1"
certificate broker "$@" mosquitto
certificate web "$@"
cp secrets/authority/ca.crt secrets/broker/ca.crt
chmod 444 secrets/broker/* secrets/web/*

if [ ! -e .env ]; then
    sed -e "s|^VIPO_HOSTS=.*|VIPO_HOSTS=$(echo "$*" | tr ' ' ',')|" -e "s|^VIPO_NAMES=.*|VIPO_NAMES=\"$*\"|" \
        -e "s|^VIPO_BROKER_URL=.*|VIPO_BROKER_URL=mqtts://$1:8883/|" deploy/env.example >.env
fi
cat <<SAID
Ready: secrets/ and .env for $*.
  secrets/authority/ca.key signs certificates: take it off this machine, and bring it back to renew one.
  secrets/authority/ca.crt is for browsers and devices, which trust this site by it.
  A certificate that browsers know already: put it, with its chain, in secrets/web/server.crt and its key in server.key.
Next: docker compose up --build --detach
SAID
