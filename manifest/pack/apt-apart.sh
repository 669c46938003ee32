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

# begin_apart FOLDER SITE SUITE [OPTIONS]: empties the folder; `state` is where apt then keeps what it knows (lists,
# archives), `settings` what makes it. OPTIONS: of the archive's line in sources.list.
begin_apart() {
  rm -rf "$1"
  mkdir -p "$1/.apt/lists/partial" "$1/.apt/archives/partial"
  state=$(cd "$1/.apt" && pwd)
  echo "deb [${4:+$4 }signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] $2 $3 main" >"$state/sources.list"
  settings=(-qq -o Dir::State::lists="$state/lists" -o Dir::Etc::sourcelist="$state/sources.list" -o Dir::Etc::sourceparts=/dev/null
            -o Dir::Cache::pkgcache= -o Dir::Cache::srcpkgcache= -o APT::Sandbox::User=root)
}
