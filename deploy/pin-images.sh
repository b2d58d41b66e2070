#!/bin/sh
# Writes the digests of the images that docker-compose.yml names into .env, so that the next start takes these bytes and
# no others. Run it with Docker and a network, look at what it says, and run it again when you want newer images.
set -eu
cd "$(dirname "$0")/.."
sed -n 's/.*\${\(VIPO_[A-Z]*_IMAGE\):-\([^}]*\)}.*/\1 \2/p' docker-compose.yml | while read -r name image; do
    docker pull --quiet "$image" >/dev/null
    digest=$(docker image inspect --format '{{index .RepoDigests 0}}' "$image")
    sed -i "/^$name=/d" .env
    echo "$name=$image@${digest#*@}" | tee -a .env
done
