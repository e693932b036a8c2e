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
syn keyword rtlangFunction abs acos acosh asc asin asinh atan atan2 atanh bitwise_and bitwise_or bitwise_xor
syn keyword rtlangFunction ceil chr concat cos cosh datetime defined degrees dimension_size dimensions div exp
syn keyword rtlangFunction file_exists floor inside int internal ln log max max_extent min min_extent mod pow
syn keyword rtlangFunction prod radians rand seed select sin sinh sqrt str strcmp strlen strlwr strupr substr
syn keyword rtlangFunction sum tan tanh trace val vaxis_rotate vcross vdot vlength vnormalize vrotate vstr
syn keyword rtlangFunction vturbulence
syn keyword rtlangConstant array clock clock_on false function no now off on pi t true u v version x y yes z
syn keyword rtlangColour alpha blue color colour filter gray green red rgb rgbf rgbft rgbt srgb srgbf srgbft
syn keyword rtlangColour srgbt transmit
syn keyword rtlangWord accuracy adaptive adc_bailout agate agate_turb albedo all_intersections altitude
syn keyword rtlangWord ambient ambient_light angle aoi aperture arc_angle area_illumination area_light
syn keyword rtlangWord assumed_gamma average background bicubic_patch black_hole blob blur_samples bounded_by
syn keyword rtlangWord box boxed bozo brick brick_size brilliance bump_map bump_size bumps camera caustics
syn keyword rtlangWord cells charset checker circular clipped_by color_map colour_map component cone
syn keyword rtlangWord confidence conserve_energy contained_by control0 control1 crackle crand cube cubic
syn keyword rtlangWord cubic_wave cylinder cylindrical density_file dents difference diffuse direction disc
syn keyword rtlangWord dist_exp distance double_illuminate emission evaluate exponent exr exterior fade_color
syn keyword rtlangWord fade_colour fade_distance fade_power falloff falloff_angle finish fisheye flip
syn keyword rtlangWord focal_point fog fog_alt fog_offset fog_type form frequency fresnel gamma global_lights
syn keyword rtlangWord global_settings gradient granite hdr height_field hexagon hf_gray_16 hierarchy hollow
syn keyword rtlangWord image_map image_pattern inside_vector interior interior_texture interpolate
syn keyword rtlangWord intersection inverse ior irid irid_wavelength isosurface jitter jpeg julia
syn keyword rtlangWord julia_fractal lambda lathe leopard light_group light_source location look_at looks_like
syn keyword rtlangWord magnet major_radius mandel map_type marble material material_map matrix max_gradient
syn keyword rtlangWord max_intersections max_iteration max_trace max_trace_level media_attenuation
syn keyword rtlangWord media_interaction merge mesh mesh2 metallic metric mm_per_unit mortar no_bump_scale
syn keyword rtlangWord no_image no_radiosity no_reflection no_shadow noise_generator normal normal_map
syn keyword rtlangWord number_of_waves object octaves offset omega omnimax once onion open orient orientation
syn keyword rtlangWord orthographic ovus panoramic parallel parametric pattern perspective pgm phase phong
syn keyword rtlangWord phong_size pigment pigment_map pigment_pattern planar plane png point_at poly poly_wave
syn keyword rtlangWord polygon polynomial ppm precision precompute premultiplied prism quadric quartic
syn keyword rtlangWord quaternion quick_color quick_colour quilted radial radius rainbow ramp_wave reflection
syn keyword rtlangWord reflection_exponent refraction repeat right ripples rotate roughness scale scallop_wave
syn keyword rtlangWord shadowless sine_wave sky sky_sphere slice slope slope_map smooth smooth_triangle solid
syn keyword rtlangWord sor specular sphere sphere_sweep spherical spiral1 spiral2 split_union spotlight
syn keyword rtlangWord spotted sqr strength sturm superellipsoid text texture texture_map tga thickness
syn keyword rtlangWord threshold tiff tightness tiles tolerance toroidal torus transform translate triangle
syn keyword rtlangWord triangle_wave turb_depth turbulence ultra_wide_angle union up uv_mapping variance warp
syn keyword rtlangWord water_level waves width wood wrinkles

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
