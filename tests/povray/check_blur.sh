#!/bin/sh
# Focal blur against POV-Ray: the same picture but for the noise of both, at 200 rays a pixel. Prints TAP.
# SPDX-License-Identifier: MIT
: "${RTCHECK:?}"
POVRAY=${POVRAY:-$(command -v povray)}
if [ -z "$POVRAY" ]; then
    echo "1..1"
    echo "ok 1 - focal blur # SKIP povray is not installed"
    exit 0
fi
work=$(mktemp -d) || exit 99
trap 'rm -rf "$work"' EXIT
cat > "$work/lens.scn" <<'SCENE'
#version 3.7; global_settings { assumed_gamma 1 }
camera { location <0, 2, -10> right x * 4/3 angle 40 look_at 0 aperture 1.5 blur_samples 200 focal_point <2, 0, -2>
  variance 0 confidence 0.99 }
light_source { <-8, 12, -10> rgb 1 }
plane { y, -1 pigment { checker rgb 0.9 rgb 0.2 } finish { ambient 0.1 diffuse 0.8 } }
sphere { <0, 0, -2>, 1 pigment { rgb <1, 0.4, 0.2> } finish { ambient 0.1 diffuse 0.7 } }
sphere { <3, 0, 4>, 1 pigment { rgb <0.2, 1, 0.3> } finish { ambient 0.1 diffuse 0.7 } }
sphere { <-1.4, 0, -5>, 0.6 pigment { rgb <0.2, 0.3, 1> } finish { ambient 0.1 diffuse 0.7 } }
SCENE
# A lens a tenth wider would be beyond both bars.
status=0
said=$("$RTCHECK" --povray="$POVRAY" -W 80 -H 60 --threshold=0.12 --ties=0.002 "$work/lens.scn") || status=1
rmse=$(printf '%s\n' "$said" | sed -n 's/.*rmse \([0-9.]*\),.*/\1/p')
echo "1..2"
[ "$status" -eq 0 ] && echo "ok 1 - no pixel is off by more than noise" || echo "not ok 1 - no pixel is off by more than noise: $said"
if [ "${rmse%%.*}" -lt 700 ]; then
    echo "ok 2 - root mean square $rmse/65535, at most 700"
else
    echo "not ok 2 - root mean square $rmse/65535, at most 700"
    status=1
fi
exit $status
