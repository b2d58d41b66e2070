#!/bin/sh
# Makes what a site needs before its first start: secrets, certificates, and .env with the site's name.
# usage: deploy/set-up.sh NAME [NAME ...]   (names and addresses of this server; browsers use the first one)
#        deploy/set-up.sh --renew SECRET    (django-key, redis-password, broker-password, broker or web)
# What is there already is left alone. The folder secrets/ is for its owner only; the containers see single files of it.
set -eu
cd "$(dirname "$0")/.."
umask 077

# All that can be refused is looked at before anything is changed.
renewed=""
if [ "${1:-}" = --renew ]; then
    renewed=${2:-}
    case $renewed in
    django-key | redis-password | broker-password | broker | web) ;;
    *)
        echo "usage: deploy/set-up.sh --renew django-key|redis-password|broker-password|broker|web" >&2
        exit 2
        ;;
    esac
    [ -e .env ] || {
        echo "There is no .env here yet; deploy/set-up.sh NAME makes it." >&2
        exit 1
    }
fi
names=""
[ ! -e .env ] || names=$(sed -n 's/^VIPO_NAMES="\{0,1\}\([^"]*\)"\{0,1\}$/\1/p' .env | tr -s ' ')
if [ -n "$renewed" ]; then
    # shellcheck disable=SC2086
    set -- $names
    names="$*"
    [ "$#" -gt 0 ] || {
        echo "VIPO_NAMES in .env names nothing; write the names and addresses of this server there." >&2
        exit 1
    }
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
others="To give the site other names, write them into VIPO_NAMES, VIPO_HOSTS and VIPO_BROKER_URL in .env, then run\
 deploy/set-up.sh --renew broker and deploy/set-up.sh --renew web."
if [ -e .env ] && [ "$names" != "$*" ]; then
    echo ".env is for '$names', not for '$*'; nothing was changed. $others" >&2
    exit 1
fi
if [ -z "$renewed" ] && [ -s secrets/broker/server.crt ]; then
    for name in "$@"; do
        case $name in
        *:*) look=-checkip ;;
        *[!0-9.]*) look=-checkhost ;;
        *) look=-checkip ;;
        esac
        openssl x509 -in secrets/broker/server.crt -noout "$look" "$name" | grep -q 'does match' || {
            echo "The broker's certificate does not name '$name'; nothing was changed. $others" >&2
            exit 1
        }
    done
fi

mkdir -p secrets/authority secrets/broker secrets/web
chmod 700 secrets

take() { # FILE: FILE.new takes its place
    # The file is readable in the containers that it is given to, whoever they run as; nobody else gets to it, for the
    # folder above is closed.
    chmod 444 "$1.new"
    mv -f "$1.new" "$1"
}

authority() {
    [ -s secrets/authority/ca.crt ] && return
    openssl req -x509 -newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -nodes -days 3650 -subj "/CN=VIPO of $1" \
        -addext basicConstraints=critical,CA:TRUE -addext keyUsage=critical,keyCertSign,cRLSign \
        -keyout secrets/authority/ca.key -out secrets/authority/ca.crt 2>/dev/null
}

certificate() { # FOLDER NAME ...
    folder=secrets/$1
    [ "$1" != "$renewed" ] && [ -s "$folder/server.crt" ] && return
    shift
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
    rm -f "$folder/server.key.new" "$folder/server.crt.new" # of a run that was broken off
    openssl req -newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -nodes -subj "/CN=$1" \
        -keyout "$folder/server.key.new" -out "$folder/server.csr" 2>/dev/null
    printf 'subjectAltName=%s\nbasicConstraints=CA:FALSE\nkeyUsage=digitalSignature\nextendedKeyUsage=serverAuth\n' \
        "${names#,}" >"$folder/server.ext"
    openssl x509 -req -in "$folder/server.csr" -CA secrets/authority/ca.crt -CAkey secrets/authority/ca.key \
        -CAcreateserial -days 825 -sha256 -extfile "$folder/server.ext" -out "$folder/server.crt.new" 2>/dev/null
    rm "$folder/server.csr" "$folder/server.ext"
    rm -f "$folder/server.crt" # a key without its certificate is made again, and never beside another one's
    take "$folder/server.key"
    take "$folder/server.crt"
}

if [ ! -e .env ]; then
    hosts="" # an address of IPv6 stands in brackets where a port may follow
    for name in "$@"; do
        case $name in
        *:*) hosts="$hosts,[$name]" ;;
        *) hosts="$hosts,$name" ;;
        esac
    done
    hosts=${hosts#,}
    sed -e "s|^VIPO_HOSTS=.*|VIPO_HOSTS=$hosts|" -e "s|^VIPO_NAMES=.*|VIPO_NAMES=\"$*\"|" \
        -e "s|^VIPO_BROKER_URL=.*|VIPO_BROKER_URL=mqtts://${hosts%%,*}:8883/|" deploy/env.example >.env.new
    mv -f .env.new .env
fi

for secret in django-key database-password redis-password broker-password; do
    [ "$secret" != "$renewed" ] && [ -s "secrets/$secret" ] && continue
    rm -f "secrets/$secret.new"
    openssl rand -hex 32 >"secrets/$secret.new"
    # the former keys stay in further lines: they read what was sealed with them, and sign nothing
    if [ "$secret" = django-key ] && [ -e secrets/django-key ]; then
        cat secrets/django-key >>secrets/django-key.new
    fi
    take "secrets/$secret"
done
authority "$1"
certificate broker "$@" mosquitto
certificate web "$@"
rm -f secrets/broker/ca.crt.new
cp secrets/authority/ca.crt secrets/broker/ca.crt.new
take secrets/broker/ca.crt
chmod 444 secrets/django-key secrets/*-password secrets/broker/* secrets/web/* # also what somebody put there by hand

cat <<SAID
Ready: secrets/ and .env for $*.
  secrets/authority/ca.key signs certificates: take it off this machine, and bring it back to renew one.
  secrets/authority/ca.crt is for browsers and devices, which trust this site by it.
  A certificate that browsers know already: put it, with its chain, in secrets/web/server.crt and its key in server.key.
Next: docker compose up --build --detach
SAID
