#!/bin/sh
# Makes a certificate authority of your own and a server certificate for the broker, valid for 825 days.
# usage: make-certificates.sh FOLDER [NAME ...]   (names and addresses by which devices reach the broker)
# Give ca.crt to the devices; keep ca.key away from the server. Existing files are left alone.
set -eu
folder=${1:?usage: make-certificates.sh FOLDER [NAME ...]}
shift
[ "$#" -gt 0 ] || set -- mosquitto localhost 127.0.0.1
mkdir -p "$folder"
cd "$folder"
[ -e server.crt ] && { echo "There are certificates in $folder already; remove them to make new ones."; exit 0; }
umask 077
names=""
for name in "$@"; do
    case $name in
    *:*) names="$names,IP:$name" ;;
    *[!0-9.]*) names="$names,DNS:$name" ;;
    *) names="$names,IP:$name" ;;
    esac
done
openssl req -x509 -newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -nodes -days 3650 -subj "/CN=VIPO devices" \
    -addext basicConstraints=critical,CA:TRUE -addext keyUsage=critical,keyCertSign,cRLSign \
    -keyout ca.key -out ca.crt 2>/dev/null
openssl req -newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -nodes -subj "/CN=$1" \
    -keyout server.key -out server.csr 2>/dev/null
printf 'subjectAltName=%s\nbasicConstraints=CA:FALSE\nkeyUsage=digitalSignature\nextendedKeyUsage=serverAuth\n' \
    "${names#,}" >server.ext
openssl x509 -req -in server.csr -CA ca.crt -CAkey ca.key -CAcreateserial -days 825 -sha256 \
    -extfile server.ext -out server.crt 2>/dev/null
rm server.csr server.ext
chmod 644 ca.crt server.crt
echo "Made ca.crt, server.crt and server.key in $folder."
