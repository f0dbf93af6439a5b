# What scripts share that install what they need; sourced. Nothing is judged where that is not here and cannot be had: 3.
cannot_install() {
    echo "cannot install $*" >&2
    exit 3
}

# Installs Debian packages, or prints the command where that may not be done.
apt_install() {
    if [ "$(id -u)" = 0 ]; then
        as_root=
    elif command -v sudo >/dev/null 2>&1 && sudo -n true 2>/dev/null; then
        as_root="sudo -n"
    else
        echo "missing packages; run: sudo apt-get install $*" >&2
        exit 3
    fi
    echo "installing $*" >&2
    $as_root env DEBIAN_FRONTEND=noninteractive apt-get update -qq >&2 || true
    $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "$@" >&2 ||
        cannot_install "$@"
}

# Chromium, Node, and what the package-lock.json of a folder names, beside it, where node looks; git ignores that.
prepare_browser() {
    folder=$1
    missing=
    [ -x "${CHROMIUM:-/usr/bin/chromium}" ] || missing="$missing chromium"
    command -v node >/dev/null || missing="$missing nodejs"
    command -v npm >/dev/null || missing="$missing npm"
    # shellcheck disable=SC2086
    [ -z "$missing" ] || apt_install $missing
    if ! cmp -s "$folder/package-lock.json" "$folder/node_modules/.installed"; then
        (cd "$folder" && npm ci --no-audit --no-fund --ignore-scripts >&2) || cannot_install "what package-lock.json names"
        cp "$folder/package-lock.json" "$folder/node_modules/.installed"
    fi
    "${CHROMIUM:-chromium}" --headless --no-sandbox --disable-gpu --disable-dev-shm-usage --dump-dom about:blank >/dev/null 2>&1 ||
        cannot_install "a Chromium that starts"
}
