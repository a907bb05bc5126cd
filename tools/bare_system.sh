# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
# Sourced by scripts that try something in a system with nothing but Debian's essential packages: made by debootstrap from this
# machine's own mirror (for a release of Ubuntu, from the one that $OVIMAP_UBUNTU_MIRROR names), kept as an archive in $BARE, unpacked afresh for every trial. Needs root; nothing outside $BARE is changed.
BARE="${OVIMAP_BARE:-/tmp/ovimap-bare}"

bare_fail() {
  printf '%s\n' "$*" >&2
  exit 1
}

# The first mirror that this machine's apt is set up with.
bare_mirror() {
  sed -n -E -e 's/^URIs:[[:space:]]*([^ ]+).*/\1/p' -e 's/^deb[[:space:]]+(\[[^]]*\][[:space:]]+)?([^[ ]+).*/\2/p' \
    /etc/apt/sources.list.d/debian.sources /etc/apt/sources.list 2>/dev/null | head -n 1
}

# bare_bootstrap SUITE FOLDER
bare_bootstrap() {
  local suite="$1" folder="$2" options=(--variant=minbase --include=ca-certificates)
  case "$suite" in
    jammy | noble) ;;
    *) debootstrap "${options[@]}" "$suite" "$folder" "$(bare_mirror)"; return ;;
  esac
  local mirror="${OVIMAP_UBUNTU_MIRROR:?name a mirror of Ubuntu in it, as ubuntu.sources of a machine with it does}" keys="$BARE/ubuntu-keys" package
  # Debian's debootstrap does not trust Ubuntu: the keys come from the mirror itself, for systems that are thrown away.
  package="$(curl -fsS "$mirror/dists/$suite/main/binary-amd64/Packages.gz" | gzip -d | sed -n 's,^Filename: \(pool/main/u/ubuntu-keyring/ubuntu-keyring_.*\.deb\)$,\1,p' | head -n 1)"
  curl -fsS -o "$keys.deb" "$mirror/$package"
  dpkg -x "$keys.deb" "$keys"
  debootstrap "${options[@]}" --components=main,universe --keyring="$keys/usr/share/keyrings/ubuntu-archive-keyring.gpg" \
    "$suite" "$folder" "$mirror" gutsy
}

# bare_make SUITE: the archive, unless it is there.
bare_make() {
  local suite="$1"
  [ ! -e "$BARE/$suite.tar" ] || return 0
  mkdir -p "$BARE"
  rm -rf "$BARE/$suite.new"  # of one that broke off
  bare_bootstrap "$suite" "$BARE/$suite.new" > "$BARE/$suite.log" 2>&1 || bare_fail "debootstrap of $suite failed; see $BARE/$suite.log"
  tar -C "$BARE/$suite.new" -cf "$BARE/$suite.tar.new" .
  rm -rf "$BARE/$suite.new"
  mv "$BARE/$suite.tar.new" "$BARE/$suite.tar"
}

# bare_open SUITE: unpacks it and sets ROOT_FOLDER. What this machine trusts and how it reaches the network goes along.
bare_open() {
  [ "$(id -u)" = 0 ] || bare_fail "bare systems need root"
  command -v debootstrap > /dev/null || bare_fail "debootstrap is missing; run: apt-get install debootstrap"
  bare_make "$1"
  ROOT_FOLDER="$(mktemp -d "$BARE/$1.XXXXXX")"
  trap bare_close EXIT
  tar -C "$ROOT_FOLDER" -xf "$BARE/$1.tar"
  chmod 755 "$ROOT_FOLDER"
  cp /etc/resolv.conf "$ROOT_FOLDER/etc/resolv.conf"
  cp /etc/ssl/certs/ca-certificates.crt "$ROOT_FOLDER/etc/ssl/certs/ca-certificates.crt"
  mount --bind /proc "$ROOT_FOLDER/proc"
  mount --bind /dev "$ROOT_FOLDER/dev"
  mount --bind /dev/pts "$ROOT_FOLDER/dev/pts"
}

# bare_checkout: this commit, as /root/ovimap.
bare_checkout() { git clone -q "$ROOT" "$ROOT_FOLDER/root/ovimap"; }

# bare_make_and_git TITLE: what anybody needs who has got the checkout.
bare_make_and_git() {
  bare_timed "$1" "apt-get update -q; apt-get install -y -q --no-install-recommends make git"
}

# bare_ccache NAME: objects of earlier trials of that name, so that one that broke off need not begin anew.
bare_ccache() {
  mkdir -p "$BARE/ccache.$1" "$ROOT_FOLDER/root/.cache/ccache"
  mount --bind "$BARE/ccache.$1" "$ROOT_FOLDER/root/.cache/ccache"
}

bare_close() {
  trap - EXIT
  ! mountpoint -q "$ROOT_FOLDER/root/.cache/ccache" || umount -l "$ROOT_FOLDER/root/.cache/ccache"
  umount -l "$ROOT_FOLDER/proc" "$ROOT_FOLDER/dev/pts" "$ROOT_FOLDER/dev"  # also where a process of the trial is not quite gone
  rm -rf --one-file-system "$ROOT_FOLDER" "$ROOT_FOLDER.log"
}

# bare_run COMMAND: by bash inside, in /root; $HOME and the language are a fresh user's.
bare_run() {
  chroot "$ROOT_FOLDER" /usr/bin/env HOME=/root LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive \
    PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin bash -euo pipefail -c "cd /root; $1"
}

# bare_timed TITLE COMMAND: prints how long it took by the clock and in processor time; its output only where it fails.
bare_timed() {
  local title="$1" log="$ROOT_FOLDER.log" TIMEFORMAT='%R s by the clock, %U + %S s of processor time' took
  took="$({ time bare_run "$2" > "$log" 2>&1; } 2>&1)" || { tail -n 30 "$log"; bare_fail "$title: failed"; }
  printf '%-44s %s\n' "$title:" "$took"
}
