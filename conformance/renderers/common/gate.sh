# What the renderers' gates share; sourced by each `gate` after it has set `here`, its own folder.
renderers=$(dirname "$here")
build=$renderers/.build
# The accuracy rules, unless the caller has said which.
profile=opengl
options=
# What `prepare_python` installs, and where.
requirements=$renderers/common/requirements.txt
venv=$build/python
pip_options=
arguments=$*
mkdir -p "$build"
# Mesa's device-select layer looks for a Wayland display and says so where there is none.
export NODEVICE_SELECT=1

. "$renderers/common/install.sh"

has_library() {
    for folder in /lib /usr/lib /usr/lib64 /usr/local/lib /lib/*-linux-gnu /usr/lib/*-linux-gnu; do
        [ -e "$folder/$1" ] && return 0
    done
    return 1
}

# A Python with what `common/requirements.txt` names, and the Debian packages that are asked for. A gate that needs other packages
# of Python sets `requirements` and `venv`, and `pip_options` where those packages ask for more than they use.
prepare_python() {
    missing=$*
    python3 -c 'import ensurepip, venv' 2>/dev/null || missing="$missing python3 python3-venv"
    # shellcheck disable=SC2086
    [ -z "$missing" ] || apt_install $missing
    python=$venv/bin/python3
    if ! cmp -s "$requirements" "$venv/requirements.txt"; then
        rm -rf "$venv"
        python3 -m venv "$venv"
        # shellcheck disable=SC2086
        "$python" -m pip install --quiet --disable-pip-version-check $pip_options -r "$requirements" >&2 ||
            cannot_install "what ${requirements#"$renderers"/} names"
        cp "$requirements" "$venv/requirements.txt"
    fi
}

# What Mesa's software OpenGL through EGL lacks here.
missing_mesa() {
    missing=
    has_library libEGL.so.1 || missing="$missing libegl1"
    has_library libOpenGL.so.0 || has_library libGL.so.1 || missing="$missing libgl1"
    has_library libEGL_mesa.so.0 || missing="$missing libegl-mesa0"
    has_library dri/swrast_dri.so || has_library libgallium.so || missing="$missing libgl1-mesa-dri"
}

# Mesa's software OpenGL through EGL, and that Python.
prepare_opengl() {
    missing_mesa
    # shellcheck disable=SC2086
    prepare_python $missing
    (cd "$renderers/common" && "$python" -c 'import context; context.create()') >&2 ||
        cannot_install "an OpenGL 4.5 of the compatibility profile"
}

# Mesa's software Vulkan, unless the caller has chosen a driver or an adapter of it, and that Python.
prepare_vulkan() {
    missing=
    has_library libvulkan.so.1 || missing="$missing libvulkan1"
    if [ -z "${VK_ICD_FILENAMES:-}${VK_DRIVER_FILES:-}${PYGFX_WGPU_ADAPTER_NAME:-}" ]; then
        has_library libvulkan_lvp.so || missing="$missing mesa-vulkan-drivers"
        export PYGFX_WGPU_ADAPTER_NAME=llvmpipe
        # In threads of its own it flushes subnormals, until one of them has drawn to halves.
        export LP_NUM_THREADS="${LP_NUM_THREADS-0}"
    fi
    # shellcheck disable=SC2086
    prepare_python $missing
}

# Adds an option and its value to `options` unless the caller has said it.
default_option() {
    case " $arguments " in
        *" $1 "* | *" $1="*) ;;
        *) options="$options $1 $2" ;;
    esac
}

# The binary that the caller has named, or the one that cargo builds.
run_lightmeter() {
    if [ -n "${LIGHTMETER:-}" ]; then
        "$LIGHTMETER" "$@"
    else
        cargo run --quiet --manifest-path "$renderers/../../Cargo.toml" --bin lightmeter -- "$@"
    fi
}

# Sets `kept` to the option that keeps a result as JSON, where the caller has named a folder, `RENDERER_RESULTS`: one file a result, of which
# a gate may have several.
keep_result() {
    kept=
    [ -n "${RENDERER_RESULTS:-}" ] || return 0
    file=$RENDERER_RESULTS/$(basename "$here")
    count=1
    while [ -e "$file-$count.json" ]; do count=$((count + 1)); done
    kept=$file-$count.json
}

# Judges files of answers to a pack.
run_files() {
    keep_result
    run_lightmeter gate "$@" ${kept:+--json "$kept"}
}

# Runs the gate over a command; what the caller says stands last. Without it there are 64 cases of each formula, and known
# failures are those of `expected.toml`.
run_gate() {
    command=$1
    shift
    default_option --profile "$profile"
    default_option --cases 64
    expected=
    [ ! -e "$here/expected.toml" ] || expected=$here/expected.toml
    case " $arguments " in *" --expect"*) expected= ;; esac
    keep_result
    set -- --exec "$command" ${expected:+--expect "$expected"} ${kept:+--json "$kept"} "$@"
    # shellcheck disable=SC2086
    run_lightmeter gate $options "$@"
}
