# Sourced by the clients, programs that nobody here wrote. Each is called as
#     NAME MANIFEST FOLDER
# and runs on the driver that the manifest names, leaves logs and pictures in FOLDER, ends with 0 (right), 77 (a package
# is missing) or anything else (wrong), and says in its last line what it saw.
set -uo pipefail
[ $# -eq 2 ] && [ -f "$1" ] || { echo "usage: ${0##*/} MANIFEST FOLDER" >&2; exit 64; }
clients=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
manifest=$(readlink -f "$1")
out=$2
mkdir -p "$out"
export VK_ICD_FILENAMES=$manifest VK_DRIVER_FILES=$manifest
# Mesa's implicit layer that sorts devices stays out.
export VK_LOADER_LAYERS_DISABLE=VK_LAYER_MESA_device_select NODEVICE_SELECT=1
export XDG_RUNTIME_DIR=${XDG_RUNTIME_DIR:-/tmp/xdg-$(id -u)}
mkdir -p -m 700 "$XDG_RUNTIME_DIR"

need() {
    for program in "$@"; do
        command -v "$program" >/dev/null || { echo "no $program"; exit 77; }
    done
}

wrong() {
    echo "$*"
    exit 1
}

# Starts again inside a private X server, once.
need_x() {
    [ -n "${inside_x:-}" ] && return
    need Xvfb import
    inside_x=1 exec "$clients/with-x" "$0" "$manifest" "$out"
}

# OpenGL on Vulkan: Mesa's Zink, which takes a CPU device if, and only if, software rendering is asked for.
use_zink() {
    need vulkaninfo
    export MESA_LOADER_DRIVER_OVERRIDE=zink
    unset LIBGL_ALWAYS_SOFTWARE
    if vulkaninfo --summary 2>/dev/null | grep -q 'deviceType *= PHYSICAL_DEVICE_TYPE_CPU'; then
        export LIBGL_ALWAYS_SOFTWARE=1
    fi
}

# picture FILE COLOURS COMMAND...: runs the command until the screen shows at least so many colours, at most 20 s, and keeps
# a picture of the screen. Fails when it never does, or when the command ends by itself with an error before.
picture() {
    local file=$1 colours=$2 pid seen=0
    shift 2
    "$@" >"$file.log" 2>&1 &
    pid=$!
    for _ in $(seq 40); do
        sleep 0.5
        import -window root "$file"
        seen=$(identify -format %k "$file")
        [ "$seen" -ge "$colours" ] && break
        kill -0 "$pid" 2>/dev/null || break
    done
    kill "$pid" 2>/dev/null
    wait "$pid" 2>/dev/null
    shown=$seen
    [ "$seen" -ge "$colours" ]
}

# The web clients and what they need from npm, in a folder that may be written to; the working directory afterwards.
use_web() {
    need node npm
    local home=${XDG_CACHE_HOME:-$HOME/.cache}/vernier-web
    mkdir -p "$home"
    cp "$clients"/web/* "$home"
    cd "$home" || exit 1
    # The package webgpu fetches nothing when it is installed; its script only checks the platform.
    [ -d node_modules/webgpu ] && [ -d node_modules/three ] && [ -d node_modules/playwright-core ] ||
        npm install --no-audit --no-fund >"$out/npm.log" 2>&1 || { echo "no packages from npm"; exit 77; }
}
