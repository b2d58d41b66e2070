# One image for all of VIPO's processes; docker-compose.yml says which one a container runs.
# The two images can be given with their digests: deploy/pin-images.sh.
ARG PYTHON_IMAGE=python:3.11.13-slim-bookworm
ARG NODE_IMAGE=node:20.19.4-bookworm-slim
FROM ${NODE_IMAGE} AS frontend
WORKDIR /build
COPY frontend/package.json frontend/package-lock.json ./
RUN npm ci --no-audit --no-fund --loglevel=error
COPY frontend/ ./
RUN npx vite build --logLevel warn

FROM ${PYTHON_IMAGE}
ENV PYTHONUNBUFFERED=1 PYTHONDONTWRITEBYTECODE=1 VIPO_MODE=served VIPO_STATE_DIR=/state \
    DJANGO_SETTINGS_MODULE=vipo_site.settings
WORKDIR /vipo
# PyBullet's wheel is made for manylinux; nothing is compiled here.
COPY pyproject.toml constraints.txt manage.py ./
COPY vipo_device vipo_device
COPY vipo_site vipo_site
COPY registry registry
COPY editor editor
COPY simulation simulation
COPY execution execution
COPY connectors connectors
RUN pip install --no-cache-dir --disable-pip-version-check --constraint constraints.txt --editable . \
    && useradd --system --uid 10001 --home-dir /state vipo && mkdir -p /state /archive /mosquitto/config \
    && chown vipo: /state /archive && chown 1883:1883 /mosquitto/config && chmod 700 /state /archive /mosquitto/config
COPY examples examples
COPY --from=frontend /build/dist frontend/dist
USER vipo
EXPOSE 8000
CMD ["daphne", "-b", "0.0.0.0", "-p", "8000", "--websocket-max-message-size", "16777216", "--websocket-max-frame-size", "16777216", "vipo_site.asgi:application"]
