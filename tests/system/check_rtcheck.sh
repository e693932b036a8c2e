#!/bin/sh
# rtcheck's judgement, messages and exit codes, with stand-ins for POV-Ray. $RTCHECK and $RTLANG name the programs. Prints TAP.
# SPDX-License-Identifier: MIT
: "${RTCHECK:?}" "${RTLANG:?}"
work=$(mktemp -d) || exit 99
trap 'rm -rf "$work"' EXIT
mkdir "$work/a folder" "$work/include" "$work/tmp" && cd "$work/a folder" || exit 99
TMPDIR=$work/tmp
export TMPDIR
number=0

scene='#version 3.7; global_settings { assumed_gamma 1 }
camera { location -3*z look_at 0 } light_source { <4,5,-6> rgb 1 } sphere { 0, 1 pigment { rgb <1,.5,.2> } }'
printf '%s\n' "$scene" > 'a scene.scn'
printf '%s\n#include "more.inc"\n' "$scene" > includes.scn
echo 'sphere { x, .5 pigment { rgb x } }' > "$work/include/more.inc"
printf '%s\nnonsense\n' "$scene" > wrong.scn

# stand_in NAME COMMANDS: a povray that has $output, $ours (rtlang's picture of the same scene) and $width.
stand_in() {
    {
        echo '#!/bin/sh'
        echo 'for a; do case $a in +O*) output=${a#+O?}; output=${output%?};; +W[0-9]*) width=${a#+W};; esac; done'
        echo 'ours=${output%.povray.png}.rtlang.png'
        echo "$2"
    } > "$work/$1"
    chmod +x "$work/$1"
}
stand_in same 'cp "$ours" "$output"'
stand_in busy 'if [ ! -e "$TMPDIR/../tried" ]; then
    : > "$TMPDIR/../tried"
    echo "Timed out waiting for worker thread startup"
    exit 1
fi
cp "$ours" "$output"'
stand_in other 'cp "${ours%/*}/01-a scene.scn.rtlang.png" "$output"'
stand_in fails 'echo the reason is here >&2; exit 7'
stand_in lazy 'echo nothing to do >&2'
stand_in here 'test -f "./a scene.scn" && for a; do echo "$a" >&2; done; exit 1'
stand_in cut 'head -c 100 "$ours" > "$output"'
# One that has white where rtlang has black.
stand_in exchanged 'sed "s/rgb 1, rgb 0/rgb 0, rgb 1/" doubt.scn > ../exchanged.scn
"$RTLANG" -q -W 16 -H 8 --depth=16 --file-gamma=1 -o "$output" ../exchanged.scn'

# elsewhere NAME WHERE COUNT: one that has COUNT red pixels more than rtlang in each picture that WHERE, a list, names:
# the scene's own, that with its camera turned, and those of what rtlang wrote of it, as it is or in other sizes.
elsewhere() {
    stand_in "$1" 'for a; do case $a in +I*) input=${a#+I?}; input=${input%?};; esac; done
case $input in *elsewhere.pov) is=resized;; *) is=own;; esac
grep -q "rotate <[-0-9.e]*, [-0-9.e]*, 9e-11> }" "$input" && is=turned
[ $is = resized ] && grep -q "location <0, 0, -5>" "$input" && is=written
cp "$input" "$TMPDIR/../drawn.scn"
echo $is >> "$TMPDIR/../drawn"
red="box { <0,0,-1>, <'"$3"',1,-.5> pigment { rgb <1,0,0> } finish { ambient 1 diffuse 0 } no_shadow"
case " '"$2"' " in *" $is "*) echo "$red } $red scale 64 } $red scale 1024 } $red scale 16384 }" >> "$TMPDIR/../drawn.scn";; esac
"$RTLANG" -q -W 64 -H 48 --depth=16 --file-gamma=1 -o "$output" "$TMPDIR/../drawn.scn"'
}
elsewhere steady 'own turned written resized' 2
elsewhere turns 'own written resized' 2
elsewhere small 'own turned written' 2
elsewhere misread 'own turned' 2
elsewhere misread-resized 'own turned resized' 2
elsewhere many 'own written' 4
elsewhere most 'own written' 3
elsewhere misread-much 'own turned' 4
stand_in once 'case $output in *elsewhere.png) exit 1;; esac
"$TMPDIR/../steady" "$@"'

# expect NAME STATUS PATTERN ARGUMENT...: runs rtcheck; its output must match the pattern of case.
expect() {
    name=$1 status=$2 pattern=$3
    shift 3
    output=$("$RTCHECK" "$@" 2>&1)
    found=$?
    number=$((number + 1))
    eval "case \$output in $pattern) matches=yes;; *) matches=no;; esac"
    if [ $found -eq "$status" ] && [ $matches = yes ]; then
        echo "ok $number - $name"
    else
        echo "not ok $number - $name"
        echo "# status $found, wanted $status; output: $output" | sed '2,$s/^/# /'
        failed=1
    fi
}

expect 'equal pictures agree' 0 \
    '"a scene.scn: max 0, rmse 0, psnr inf dB, flip 0, beyond 0 (0.0000 %), beyond 1/65535 0, beyond 1/255 0, "*"x): ok"' \
    -W 16 -H 8 --povray "$work/same" 'a scene.scn'
expect 'a start that failed for want of time is tried again' 0 '*": ok"' -W 16 -H 8 --povray "$work/busy" 'a scene.scn'
expect 'POV-Ray is given the folder of include files that rtlang searches' 1 '*"+L\""*"/share/rtlang\""*' \
    -W 16 -H 8 --povray "$work/here" 'a scene.scn'
expect 'different pictures do not' 1 '*"includes.scn: max "*": FAIL"' \
    -W 16 -H 8 -I ../include --povray "$work/other" 'a scene.scn' includes.scn
expect 'unless so many may differ' 0 '*"includes.scn: "*": ok"' \
    -W 16 -H 8 -I ../include --ties 1/1 --povray "$work/other" 'a scene.scn' includes.scn
expect 'or by so much' 0 '*"includes.scn: "*": ok"' \
    -W 16 -H 8 -I ../include --threshold 1 --povray "$work/other" 'a scene.scn' includes.scn
expect 'JSON' 0 '"{\"scene\": \"a scene.scn\", \"agrees\": true, \"max\": 0,"*"\"psnr\": null"*"}"' \
    --json -W 16 -H 8 --povray "$work/same" 'a scene.scn'
expect 'a fault in the scene is told' 1 '"wrong.scn: FAIL: rtlang:"*"wrong.scn:3:1"*' --povray "$work/same" wrong.scn
expect 'a missing scene' 1 '*"nowhere.scn"*"not found"*' --povray "$work/same" nowhere.scn
expect 'POV-Ray fails' 1 '*"povray ended with status 7:"*"the reason is here"' --povray "$work/fails" 'a scene.scn'
expect 'POV-Ray makes nothing' 1 '*"povray made no picture:"*"nothing to do"' --povray "$work/lazy" 'a scene.scn'
expect 'half a picture' 1 '*"cannot read "*".povray.png: "*' --povray "$work/cut" 'a scene.scn'
printf '#if (clock != 0.25 | !clock_on) #error "no clock" #end sphere { 0, 1 }\n' > clock.scn
expect 'the clock is given to rtlang' 0 '"clock.scn: "*": ok"' -W 16 -H 8 -K 0.25 --povray "$work/same" clock.scn
expect 'and is not otherwise' 1 '*"no clock"*' -W 16 -H 8 --povray "$work/same" clock.scn
printf '#fopen F "said.txt" write #write (F, 1) #fclose F sphere { 0, 1 }\n' > writes.scn
expect 'a scene may not write' 1 '*"may not write"*' -W 16 -H 8 --povray "$work/same" writes.scn
expect 'but where it is allowed' 0 '"writes.scn: "*": ok"' -W 16 -H 8 --allow-write . --povray "$work/same" writes.scn
expect 'no POV-Ray' 3 '"rtcheck: no program \`nosuch\` found"*' --povray nosuch 'a scene.scn'
expect 'no scene' 2 '*"no scene given"*' --json
expect 'a wrong number' 2 '*"--width\` wants"*"found \`0\`"*' --width 0 'a scene.scn'
expect 'an unknown option' 2 '*"--nope"*' --nope 'a scene.scn'
expect 'a missing folder' 2 '*"nowhere: No such file"*' -I nowhere --povray "$work/same" 'a scene.scn'
expect 'a report that cannot be written' 2 '*"cannot write the report /dev/null/out: Not a directory"*' \
    --report /dev/null/out --povray "$work/same" 'a scene.scn'
mkdir -p "$work/taken/index.html"
expect 'nor over a folder' 2 '*"cannot write the report "*"/taken/index.html: Is a directory"*' \
    -W 16 -H 8 --report "$work/taken" --povray "$work/same" 'a scene.scn'
# range NAME PATTERN TEXT: what is told of a scene that holds the text, too.
range() {
    printf '%s\n%s\n' "$scene" "$3" > range.scn
    expect "$1" 0 "$2" -W 16 -H 8 --povray "$work/same" range.scn
}
outside="outside POV-Ray's range: "
range 'in range' '*"x): ok"' 'plane { y, -1e9 } sphere { -1e12*y, .999999999e12 }'
range 'a shape out of range' "*\"x), ${outside}a shape at a distance of 2e+06: ok\"" 'sphere { 3e6*z, 1e6 }'
range 'a camera out of range' "*\", ${outside}a camera at 2e+06: ok\"" 'camera { location 2e6*y look_at 1e6*y }'
range 'a shape too small' "*\", ${outside}a shape of size 0.0005: ok\"" 'box { 0, <6e-4,8e-4,0> }'
range 'a shape that looks too small' "*\", ${outside}a shape whose size over its distance is 5e-06: ok\"" \
    'sphere { 2e5*z, 1 }'
printf '%s\n' "$scene" | sed 's/-3\*z/-.03*z/; s/0, 1 /0, .02 /' > range.scn
expect 'a scene too small' 0 "*\", ${outside}nothing farther than 0.05: ok\"" -W 16 -H 8 --povray "$work/same" range.scn
# A plane in which faces of the checker's cubes lie, which end 1e-10 before whole numbers: rounding alone says on which
# side each of the 128 pixels is.
doubt() {
    cat > doubt.scn <<EOF
#version 3.7; global_settings { assumed_gamma 1 }
camera { orthographic location -5*z look_at 0 right 16*x up 8*y } light_source { <4,5,-6> rgb 1 }
plane { z, 0 pigment { checker rgb 1, rgb 0 translate $1*z } finish { ambient 1 diffuse 0 } rotate <0, 30, 0> }
$2
EOF
}
doubt 1e-10
expect 'pixels that rounding decides differ' 1 '*"beyond 128 "*"x): FAIL"' -W 16 -H 8 --povray "$work/exchanged" doubt.scn
expect 'and are told from others' 0 '*"beyond 128 "*", 128 by rounding, "*"x): ok"' \
    -W 16 -H 8 --doubts 30 --povray "$work/exchanged" doubt.scn
expect 'in JSON' 0 '*"\"agrees\": true, "*"\"beyond\": 128, "*"\"by_rounding\": 128"*' \
    --json -W 16 -H 8 --doubts 30 --povray "$work/exchanged" doubt.scn
doubt 0.5
expect 'pixels that rounding does not decide count' 1 '*"beyond 128 "*"255 128, rtlang "*"x): FAIL"' \
    -W 16 -H 8 --doubts 5 --povray "$work/exchanged" doubt.scn
doubt 1e-10 'box { <-3,-2,-2>, <2,1,-1> pigment { checker rgb 1, rgb 0 translate 0.25 } finish { ambient 1 diffuse 0 } }'
expect 'beside those that it does' 1 '*"beyond 128 "*", 113 by rounding, "*"x): FAIL"' \
    -W 16 -H 8 --doubts 30 --povray "$work/exchanged" doubt.scn
expect 'unless so few may' 0 '*", 113 by rounding, "*"x): ok"' \
    -W 16 -H 8 --doubts 30 --ties 15/128 --povray "$work/exchanged" doubt.scn
expect 'of equal pictures nothing is doubtful' 0 '*"beyond 0 "*"255 0, rtlang "*"x): ok"' \
    -W 16 -H 8 --doubts 5 --povray "$work/same" doubt.scn
# A pixel is a unit; the words of a camera in comments and strings are no cameras.
cat > cameras.scn <<'EOF'
#version 3.7; global_settings { assumed_gamma 1 } /* camera { /* nested */ } */ // camera { }
#declare Text = "camera { }";
camera/**/{ orthographic location -5*z // }
  right 64*x #if (1) up 48*y #end } light_source { <4,5,-6> rgb 1 } plane { z, 0 pigment { rgb .5 } }
EOF
# other NAME STATUS PATTERN STAND-IN PICTURES: where POV-Ray's pictures differ as the stand-in says.
other() {
    rm -f ../drawn
    expect "$1" "$2" "$3" -W 64 -H 48 --ties 0 --povray "$work/$4" --elsewhere "$5" cameras.scn
}
other 'what POV-Ray always draws counts' 1 '*"beyond 2 "*"/255 2, 2 where it is larger, rtlang "*"x): FAIL"' steady 4
other 'what a turn of the camera changes does not' 0 '*"beyond 2 "*", 2 not elsewhere, "*"x): ok"' turns 1
other 'nor what another size changes' 0 '*"beyond 2 "*", 2 not elsewhere, "*"x): ok"' small 4
other 'what rtlang misread is not excused by its own text' 1 '*"beyond 2 "*"/255 2, 2 where it is larger, rtlang "*"x): FAIL"' misread 24
other 'nor where that text is another one by size' 1 '*"beyond 2 "*"/255 2, 2 where it is larger, rtlang "*"x): FAIL"' misread-resized 24
other 'one of a thousand pixels may be excused' 0 '*"beyond 3 "*", 3 not elsewhere, "*"x): ok"' most 8
other 'one more may not' 1 '*"beyond 4 "*"/255 4, 0 where it is larger, rtlang "*"x): FAIL"' many 8
other 'and where much is read otherwise nothing is said' 1 '*"beyond 4 "*"/255 4, rtlang "*"x): FAIL"' misread-much 8
expect 'in JSON' 1 '*"\"larger\": 0"*' --json -W 64 -H 48 --ties 0 --elsewhere 8 --povray "$work/many" cameras.scn
expect 'in JSON' 0 '*"\"agrees\": true, "*"\"beyond\": 2, "*"\"not_elsewhere\": 2"*' \
    --json -W 64 -H 48 --ties 0 --elsewhere 1 --povray "$work/turns" cameras.scn
other 'POV-Ray need not be able to draw it' 1 '*"beyond 2 "*"/255 2, rtlang "*"x): FAIL"' once 4
expect 'no number of places' 2 '*"--elsewhere\` wants a whole number from 1 to 100"*' --elsewhere 101 'a scene.scn'
expect 'no number of doubts' 2 '*"--doubts\` wants a whole number from 1 to 1000"*' --doubts 0 'a scene.scn'
expect 'help' 0 '"Usage: rtcheck "*' --help
cd / || exit 99
expect 'POV-Ray runs in the folder of the scene, with these switches' 1 \
    '*"+I\"./a scene.scn\""*"+FN16"*"File_Gamma=1.0"*"-D"*"-A"*"+W16"*"+H8"*"+WT1"*"+K0.25"*"+L\"$work/include\""*' \
    -W 16 -H 8 -j 1 --clock=0.25 -I "$work/include" --povray "$work/here" "$work/a folder/a scene.scn"
expect 'pictures are kept where asked' 0 '*": ok"' \
    -W 16 -H 8 --keep "$work/kept" --povray "$work/same" "$work/a folder/a scene.scn"
number=$((number + 1))
if [ -s "$work/kept/01-a scene.scn.rtlang.png" ] && [ -z "$(ls -A "$TMPDIR")" ]; then
    echo "ok $number - kept, and nothing else left behind"
else
    echo "not ok $number - kept, and nothing else left behind"
    failed=1
fi
echo "1..$number"
exit ${failed:-0}
