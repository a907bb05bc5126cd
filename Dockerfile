# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
# The program in an image: the Debian package of `make packages` on a plain Debian 12. UNTESTED: where this was written no container
# could be started; the package itself is tried in bare systems by tools/packages_test.sh.
#   docker build -t ovimap .
#   docker run --rm -v "$PWD:/data" ovimap demo
#   docker run --rm -v "$PWD:/data" -p 127.0.0.1:8080:8080 ovimap serve room.ovimap --host 0.0.0.0 --token-file token
FROM debian:12 AS build
RUN apt-get update -q && apt-get install -y -q --no-install-recommends make git ca-certificates
COPY . /ovimap
RUN make -C /ovimap packages

FROM debian:12-slim
COPY --from=build /ovimap/build/packages/out/*.deb /tmp/
RUN apt-get update -q && apt-get install -y -q --no-install-recommends /tmp/ovimap_*.deb && rm -rf /tmp/*.deb /var/lib/apt/lists/*
WORKDIR /data
ENTRYPOINT ["ovimap"]
CMD ["--help"]
