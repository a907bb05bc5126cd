# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
# Sourced by scripts that take a package from another release, or its source, without touching this system's lists of packages. They set $SCRATCH
# and write $SCRATCH/sources.list.

# The URIs and keyrings of the host's own package sources, as "URI KEYRING" lines.
package_sources() {
  local file
  for file in /etc/apt/sources.list.d/*.sources; do
    [ -e "$file" ] || continue
    awk '/^URIs:/ {uri = $2} /^Signed-By:/ {key = $2}
         /^[[:space:]]*$/ {if (uri) print uri, key; uri = key = ""}
         END {if (uri) print uri, key}' "$file"
  done
  for file in /etc/apt/sources.list /etc/apt/sources.list.d/*.list; do
    [ ! -e "$file" ] || sed -n -E \
      -e 's/^deb[[:space:]]+\[[^]]*signed-by=([^] ]+)[^]]*\][[:space:]]+([^ ]+).*/\2 \1/p' \
      -e 's/^deb[[:space:]]+(\[[^]]*\][[:space:]]+)?([^[ ]+).*/\2/p' "$file"
  done
}

# apt with lists and cache of its own: reads another release and leaves the system's alone.
private_apt() {
  local state="$SCRATCH/apt"
  mkdir -p "$state/lists/partial" "$state/cache/archives/partial" "$state/parts"
  apt-get -q -o Dir::State="$state" -o Dir::State::lists="$state/lists" \
    -o Dir::Cache="$state/cache" -o Dir::State::status=/var/lib/dpkg/status \
    -o Dir::Etc::sourcelist="$SCRATCH/sources.list" \
    -o Dir::Etc::sourceparts="$state/parts" -o APT::Sandbox::User="$(id -un)" \
    -o Acquire::Languages=none "$@"
}
