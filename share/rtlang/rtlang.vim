" Vim syntax file: scenes of rtlang, a subset of POV-Ray's language.
" Copy it to ~/.vim/syntax/rtlang.vim and put `au BufRead,BufNewFile *.scn setfiletype rtlang` into ~/.vimrc.
" The words are those of src/ast/words.def that rtlang has a use for.
" SPDX-License-Identifier: MIT
if exists("b:current_syntax")
  finish
endif
syn case match
syn iskeyword @,48-57,_

syn match rtlangDirective "#\s*\(break\|case\|debug\|declare\|default\|else\|elseif\|end\|error\|fclose\|fopen\|for\|if\|ifdef\|ifndef\|include\|local\|macro\|range\|read\|render\|statistics\|switch\|undef\|version\|warning\|while\|write\)\>"
syn match rtlangNumber "\<\d\+\.\?\d*\([eE][-+]\?\d\+\)\?\|\.\d\+\([eE][-+]\?\d\+\)\?"
syn match rtlangEscape contained +\\\([ntabfvr\\"']\|u\x\{4}\)+
syn region rtlangString start=+"+ skip=+\\.+ end=+"+ contains=rtlangEscape
syn keyword rtlangTodo contained TODO FIXME
syn match rtlangComment "//.*" contains=rtlangTodo
syn region rtlangComment start="/\*" end="\*/" contains=rtlangComment,rtlangTodo
syn keyword rtlangFunction abs acos acosh asc asin asinh atan atan2 atanh
syn keyword rtlangFunction ceil chr concat cos cosh defined degrees dimension_size dimensions div exp
syn keyword rtlangFunction file_exists floor int ln log max min mod pow
syn keyword rtlangFunction radians rand seed select sin sinh sqrt str strcmp strlen strlwr strupr substr
syn keyword rtlangFunction tan tanh val vaxis_rotate vcross vdot vlength vnormalize vrotate vstr
syn keyword rtlangConstant clock clock_on false no now off on pi t true u v version x y yes z array
syn keyword rtlangColour alpha blue color colour filter gray green red rgb rgbf rgbft rgbt srgb srgbf srgbft
syn keyword rtlangColour srgbt transmit
syn keyword rtlangWord adc_bailout albedo ambient ambient_light angle assumed_gamma background brilliance camera
syn keyword rtlangWord conserve_energy diffuse direction emission exponent falloff finish
syn keyword rtlangWord global_settings hollow inverse light_source location look_at matrix max_intersections
syn keyword rtlangWord max_trace_level metallic mm_per_unit noise_generator number_of_waves object
syn keyword rtlangWord orthographic parallel perspective phong phong_size pigment plane point_at quick_color
syn keyword rtlangWord quick_colour reflection reflection_exponent right rotate roughness scale
syn keyword rtlangWord shadowless sky specular sphere split_union transform translate union up texture

hi def link rtlangDirective PreProc
hi def link rtlangNumber Number
hi def link rtlangEscape SpecialChar
hi def link rtlangString String
hi def link rtlangTodo Todo
hi def link rtlangComment Comment
hi def link rtlangFunction Function
hi def link rtlangConstant Constant
hi def link rtlangColour Type
hi def link rtlangWord Statement

let b:current_syntax = "rtlang"
