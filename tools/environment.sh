#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Makes the virtual environment of one Blender version, unless it is there and complete, and
# prints the path of its Python on standard output (everything else goes to standard error).
#
#   tools/environment.sh 5.2|4.5   that version
#   tools/environment.sh any       5.2 where Python 3.13 is found, else 4.5 with Python 3.11
#
# Written for the bash 3.2 that macOS has; paths may hold spaces.
set -u
root=$(cd "$(dirname "$0")/.." >/dev/null && pwd)  # with CDPATH set, cd prints where it went

# The Debian packages that hold the system libraries the bpy wheels are linked to.
debian_packages="libx11-6 libxrender1 libxfixes3 libxi6 libxkbcommon0 libxext6 libsm6 libice6 libgl1"

say() { printf '%s\n' "$*" >&2; }

python_of() { case $1 in 5.2) echo 3.13 ;; 4.5) echo 3.11 ;; esac; }

# Every place where Python $1 (3.11 or 3.13) may be, one path a line, best first.
candidates() {
  # A service or a container may have no HOME.
  local version=$1 home=${HOME:-/nonexistent} path
  type -aP "python$version" 2>/dev/null
  for path in \
    "${PYENV_ROOT:-$home/.pyenv}"/versions/"$version".*/bin/"python$version" \
    "${UV_PYTHON_INSTALL_DIR:-${XDG_DATA_HOME:-$home/.local/share}/uv/python}"/cpython-"$version".*/bin/"python$version" \
    /usr/bin/"python$version" /usr/local/bin/"python$version" \
    /opt/homebrew/bin/"python$version" \
    /Library/Frameworks/Python.framework/Versions/"$version"/bin/"python$version"; do
    [ -x "$path" ] && printf '%s\n' "$path"
  done
  if command -v uv >/dev/null 2>&1; then
    UV_PYTHON_DOWNLOADS=never uv python find --no-project "$version" 2>/dev/null
  fi
  type -aP python3 python 2>/dev/null
}

# True if $1 runs and is Python $2: a pyenv shim of a version that is not selected is on PATH,
# but does not run.
runs() {
  "$1" -c "import sys; sys.exit('%d.%d' % sys.version_info[:2] != '$2')" </dev/null >/dev/null 2>&1
}

# Makes an empty environment with pip at $2 from Python $1. Debian's own Python may lack the
# module that brings pip (ensurepip); virtualenv and uv do without it.
create() {
  local python=$1 folder=$2
  rm -rf "$folder"
  "$python" -m venv "$folder" </dev/null >/dev/null 2>&1 && has_pip "$folder" && return
  rm -rf "$folder"
  "$python" -m virtualenv "$folder" </dev/null >/dev/null 2>&1 && has_pip "$folder" && return
  rm -rf "$folder"
  command -v virtualenv >/dev/null 2>&1 &&
    virtualenv --python "$python" "$folder" </dev/null >/dev/null 2>&1 && has_pip "$folder" && return
  rm -rf "$folder"
  command -v uv >/dev/null 2>&1 &&
    uv venv --quiet --seed --python "$python" "$folder" </dev/null >/dev/null 2>&1 &&
    has_pip "$folder" && return
  rm -rf "$folder"
  return 1
}

has_pip() { "$1/bin/python" -m pip --version </dev/null >/dev/null 2>&1; }

# Imports bpy; where that fails for want of a system library, names the packages.
check_import() {
  local python=$1 message
  message=$("$python" -c 'import bpy' 2>&1 </dev/null) && return
  say "bpy is installed, but cannot be imported:"
  printf '%s\n' "$message" | tail -n 3 >&2
  case $message in
  *"cannot open shared object file"*)
    say "A system library is missing. On Debian or Ubuntu:"
    say "    apt-get install $debian_packages"
    ;;
  esac
  return 1
}

# True if the file $1 holds the sum of the requirements, $2.
stamped() { [ -f "$1" ] && [ "$(cat "$1")" = "$2" ]; }

# Makes or completes .venv-$1. Returns 2 if no fitting Python is found, 1 on other failures.
#
# Two stamps hold the sum of the requirements: `installed` once pip has ended well, `complete`
# once bpy has been imported, so that a missing system library does not cost a second download.
ensure() {
  local blender=$1 python version folder requirements want
  version=$(python_of "$blender")
  folder="$root/.venv-$blender"
  requirements="$root/tools/requirements-$blender.txt"
  want=$(cksum <"$requirements")
  if ! { stamped "$folder/complete" "$want" && runs "$folder/bin/python" "$version"; }; then
    if ! { stamped "$folder/installed" "$want" && runs "$folder/bin/python" "$version"; }; then
      make_folder "$version" "$folder" || return 2
      install "$folder" "$requirements" || return 1
      printf '%s\n' "$want" >"$folder/installed"
    fi
    check_import "$folder/bin/python" || return 1
    printf '%s\n' "$want" >"$folder/complete"
  fi
  printf '%s\n' "$folder/bin/python"
}

# Makes an empty environment for Python $1 at $2, or keeps the one there if pip once ended well
# in it: without that stamp it was interrupted half-way, and what is in it is not known.
make_folder() {
  local version=$1 folder=$2 python tried=""
  if [ -f "$folder/installed" ] && runs "$folder/bin/python" "$version" && has_pip "$folder"; then
    return
  fi
  while IFS= read -r python; do
    case $tried in *"<$python>"*) continue ;; esac
    tried="$tried<$python>"
    runs "$python" "$version" || continue
    if create "$python" "$folder"; then
      say "Made ${folder##*/} with $python."
      return
    fi
    say "$python is Python $version, but can make no virtual environment with pip; looking on."
  done <<<"$(candidates "$version")"
  return 1
}

# Installs the requirements $2 into the environment $1. The user's own settings of pip hold (index,
# proxy, certificates), but for one that no environment allows; and a proxy that first fetches all
# of a large wheel itself is silent for longer than pip's 15 seconds.
install() {
  local folder=$1 requirements=$2
  rm -f "$folder/installed" "$folder/complete"
  say "Installing bpy (about 400 MB) and the tools into ${folder##*/} ..."
  PIP_USER=no PIP_DEFAULT_TIMEOUT=${PIP_DEFAULT_TIMEOUT:-120} \
    "$folder/bin/python" -m pip install --disable-pip-version-check --no-input \
    --requirement "$requirements" </dev/null >&2 && return
  say "The installation failed; the reason stands above. Run the same command again to repeat it."
  return 1
}

how_to_get() {
  say "One way to get it: 'pyenv install $1', or 'uv python install $1', or your system's"
  say "package manager (Debian, Ubuntu: python$1 and python$1-venv; macOS: brew install python@$1)."
}

case ${1-} in
4.5 | 5.2)
  ensure "$1"
  status=$?
  if [ $status -eq 2 ]; then
    say "Error: no Python $(python_of "$1") that runs and can make a virtual environment was found;"
    say "Blender $1 needs exactly that version. Looked on PATH, in pyenv's and uv's folders and in"
    say "the usual system folders."
    how_to_get "$(python_of "$1")"
  fi
  exit $status
  ;;
any)
  for blender in 5.2 4.5; do
    ensure "$blender"
    status=$?
    [ $status -eq 2 ] || exit $status
  done
  say "Error: neither Python 3.13 (for Blender 5.2) nor Python 3.11 (for Blender 4.5) was found,"
  say "at least none that runs and can make a virtual environment. One of the two is needed."
  say "Looked on PATH, in pyenv's and uv's folders and in the usual system folders."
  how_to_get 3.13
  say "Where that has no 3.13, the same with 3.11."
  exit 2
  ;;
packages)
  printf '%s\n' "$debian_packages"
  ;;
*)
  say "usage: tools/environment.sh 5.2|4.5|any|packages"
  exit 64
  ;;
esac
