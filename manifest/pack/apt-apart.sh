# Sourced by scripts that have apt fetch and verify packages of another system, from where this system's own come, and
# unpack them; nothing is installed.

# Prints where this system's packages come from: from apt's lists, or where there are none yet, from its sources. Empty:
# apt knows no Debian archive.
debian_archive() {
  local site
  site=$(apt-get indextargets --format '$(SITE)' 'Origin: Debian' 2>/dev/null | head -n 1)
  [ -n "$site" ] || site=$(apt-get update --print-uris 2>/dev/null |
    sed -n "s|^'\(.*\)/dists/$(. /etc/os-release && echo "${VERSION_CODENAME:-}")/InRelease'.*|\1|p" | head -n 1)
  echo "$site"
}

# begin_apart FOLDER SITE SUITE [ARCHITECTURE]: empties the folder; `state` is where apt then keeps what it knows (lists,
# archives), `settings` what makes it. With an architecture apt takes that for this system's, and nothing for installed.
begin_apart() {
  rm -rf "$1"
  mkdir -p "$1/.apt/lists/partial" "$1/.apt/archives/partial"
  state=$(cd "$1/.apt" && pwd)
  echo "deb [${4:+arch=$4 }signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] $2 $3 main" >"$state/sources.list"
  settings=(-qq -o Dir::State::lists="$state/lists" -o Dir::Etc::sourcelist="$state/sources.list" -o Dir::Etc::sourceparts=/dev/null
            -o Dir::Cache::pkgcache= -o Dir::Cache::srcpkgcache= -o APT::Sandbox::User=root)
  [ -n "${4:-}" ] || return 0
  : >"$state/status"
  settings+=(-o APT::Architecture="$4" -o APT::Architectures="$4" -o Dir::State="$state" -o Dir::State::status="$state/status"
             -o Dir::Cache="$state" -o Dir::Cache::archives="$state/archives" -o Debug::NoLocking=1)
}

# relative_links FOLDER: absolute links would lead out of it.
relative_links() {
  find "$1" -type l -lname '/*' | while read -r link; do
    ln -sfn "$(realpath -m --relative-to="$(dirname "$link")" "$1$(readlink "$link")")" "$link"
  done
}
