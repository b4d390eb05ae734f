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

# still N COMMAND...: the Nth image that a program presents, the first being 0, as FOLDER/picture.png, which run-all compares
# among drivers: for programs where it does not depend on time. Needs the layer that writes frames, whose folder is
# VERNIER_FRAMES_LAYER; without it there is no picture.
still() {
    local number=$1 status
    shift
    [ -n "${VERNIER_FRAMES_LAYER:-}" ] || return 0
    rm -rf "$out/frames"
    mkdir -p "$out/frames"
    VK_ADD_LAYER_PATH=$VERNIER_FRAMES_LAYER VK_INSTANCE_LAYERS=VK_LAYER_VERNIER_frames VERNIER_FRAMES=$((number + 1)) \
        VERNIER_FRAMES_DIR=$out/frames timeout 60 "$@" >"$out/still.log" 2>&1
    status=$?
    [ "$status" -eq 0 ] || wrong "its first images ended with $status"
    convert "$out/frames/$(printf 'frame-%04d.ppm' "$number")" "$out/picture.png" || wrong "image $number is missing"
    rm -rf "$out/frames"
}

# vkcube_at_once FRAMES: the seconds that so many frames of the cube take when they need not wait for the screen. SwiftShader
# has the mode FIFO alone, without a pace.
vkcube_at_once() {
    local mode=0 start
    timeout 60 vkcube --c 1 --present_mode 0 --suppress_popups >"$out/fast.log" 2>&1 || mode=2
    start=$EPOCHREALTIME
    VERNIER_REFRESH=0 timeout 100 vkcube --c "$1" --present_mode $mode --suppress_popups >"$out/fast.log" 2>&1 || return 1
    awk "BEGIN { print $EPOCHREALTIME - $start }"
}

# Frames a second by the words that the gears of mesa-demos print after five seconds.
gears_rate() {
    vblank_mode=0 VERNIER_REFRESH=0 timeout -s INT 7 stdbuf -oL "$1" >"$out/frames.log" 2>&1
    sed -n 's/.*= *\([0-9.]*\) FPS.*/\1/p' "$out/frames.log" | head -1
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

# webgl_page PICTURE.png: the page of three.js in Chromium; sets `result` to what it says of itself, or what went wrong. The
# workarounds for drivers would refuse lavapipe WebGL 2.
webgl_page() {
    local device
    timeout 180 node browser.mjs scene.html "$1" --use-gl=angle --use-angle=vulkan --ignore-gpu-blocklist \
        --disable-gpu-watchdog --disable-gpu-driver-bug-workarounds >"$out/browser.log" 2>&1 ||
        { result=$(grep -m1 -iE 'error|exceeded' "$out/browser.log"); return 1; }
    result=$(tail -1 "$out/browser.log")
    # Chromium has a driver of its own to fall back to, silently.
    device=$(vulkaninfo --summary 2>/dev/null | sed -n 's/.*deviceName *= *\([A-Za-z]*\).*/\1/p' | head -1)
    grep -q "\"renderer\":\"[^\"]*$device" <<<"$result" || { result="not on $device: $result"; return 1; }
}
