" Vim syntax file: scenes of rtlang, a subset of POV-Ray's language.
" Copy it to ~/.vim/syntax/rtlang.vim and put `au BufRead,BufNewFile *.scn setfiletype rtlang` into ~/.vimrc.
" The words are those of src/ast/words.def.
" SPDX-License-Identifier: MIT
if exists("b:current_syntax")
  finish
endif
syn case match
syn iskeyword @,48-57,_

syn match rtlangDirective "#\s*\(break\|case\|debug\|declare\|default\|else\|elseif\|end\|error\|fclose\|fopen\|for\|if\|ifdef\|ifndef\|include\|local\|macro\|range\|read\|render\|statistics\|switch\|undef\|warning\|while\|write\)\>"
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
syn keyword rtlangConstant clock clock_on false no now off on pi t true u v version x y yes z array
syn keyword rtlangColour alpha blue color colour filter gray green red rgb rgbf rgbft rgbt srgb srgbf srgbft
syn keyword rtlangColour srgbt transmit
syn keyword rtlangWord adc_bailout ambient ambient_light angle assumed_gamma background brilliance camera
syn keyword rtlangWord conserve_energy diffuse direction distance emission exponent falloff finish
syn keyword rtlangWord global_settings hollow inverse light_source location look_at matrix max_intersections
syn keyword rtlangWord max_trace_level metallic mm_per_unit noise_generator normal number_of_waves object
syn keyword rtlangWord orthographic parallel perspective phong phong_size pigment plane point_at quick_color
syn keyword rtlangWord quick_colour radius reflection reflection_exponent right rotate roughness scale
syn keyword rtlangWord shadowless sky specular sphere split_union transform translate union up texture
" Words of POV-Ray that rtlang has no use for.
syn keyword rtlangReserved aa_level aa_threshold absorption accuracy adaptive agate agate_turb albedo all
syn keyword rtlangReserved all_intersections altitude always_sample aoi aperture append arc_angle
syn keyword rtlangReserved area_illumination area_light ascii autostop average b_spline bezier_spline
syn keyword rtlangReserved bicubic_patch black_hole blob blur_samples bokeh bounded_by box boxed bozo brick
syn keyword rtlangReserved brick_size brightness bump_map bump_size bumps caustics cells charset checker
syn keyword rtlangReserved circular clipped_by collect color_map colour_map component composite cone
syn keyword rtlangReserved confidence conic_sweep contained_by control0 control1 coords count crackle crand
syn keyword rtlangReserved cube cubic cubic_spline cubic_wave cutaway_textures cylinder cylindrical density
syn keyword rtlangReserved density_file density_map dents deprecated df3 difference disc dispersion
syn keyword rtlangReserved dispersion_samples dist_exp double_illuminate eccentricity error_bound evaluate
syn keyword rtlangReserved expand_thresholds exterior extinction face_indices facets fade_color fade_colour
syn keyword rtlangReserved fade_distance fade_power falloff_angle fisheye flatness flip focal_point fog
syn keyword rtlangReserved fog_alt fog_offset fog_type form frequency fresnel gamma gather gif global_lights
syn keyword rtlangReserved gradient granite gray_threshold height_field hexagon hf_gray_16 hierarchy
syn keyword rtlangReserved hypercomplex iff image_map image_pattern importance inside_vector interior
syn keyword rtlangReserved interior_texture interpolate intersection intervals ior irid irid_wavelength
syn keyword rtlangReserved isosurface jitter jpeg julia julia_fractal lambda lathe leopard light_group
syn keyword rtlangReserved linear_spline linear_sweep load_file looks_like low_error_factor magnet
syn keyword rtlangReserved major_radius mandel map_type marble material material_map max_gradient
syn keyword rtlangReserved max_iteration max_sample max_trace maximum_reuse media media_attenuation
syn keyword rtlangReserved media_interaction merge mesh mesh2 method metric minimum_reuse mortar
syn keyword rtlangReserved natural_spline nearest_count no_bump_scale no_image no_radiosity no_reflection
syn keyword rtlangReserved no_shadow normal_indices normal_map normal_vectors octaves offset omega omnimax
syn keyword rtlangReserved once onion open orient orientation ovus panoramic parametric pass_through pattern
syn keyword rtlangReserved pavement pgm phase photons pigment_map pigment_pattern planar png poly poly_wave
syn keyword rtlangReserved polygon polynomial pot ppm precision precompute premultiplied pretrace_end
syn keyword rtlangReserved pretrace_start prism projected_through pwr quadratic_spline quadric quartic
syn keyword rtlangReserved quaternion quilted radial radiosity rainbow ramp_wave ratio reciprocal
syn keyword rtlangReserved recursion_limit refraction repeat ripples samples save_file scallop_wave scattering
syn keyword rtlangReserved sine_wave sint16be sint16le sint32be sint32le sint8 size sky_sphere slice slope
syn keyword rtlangReserved slope_map smooth smooth_triangle solid sor spacing sphere_sweep spherical spiral1
syn keyword rtlangReserved spiral2 spline spotlight spotted sqr square strength sturm subsurface
syn keyword rtlangReserved superellipsoid sys target text texture_list texture_map tga thickness threshold
syn keyword rtlangReserved tiff tightness tile2 tiles tiling tolerance toroidal torus translucency triangle
syn keyword rtlangReserved triangle_wave triangular ttf turb_depth turbulence type u_steps uint16be uint16le
syn keyword rtlangReserved uint8 ultra_wide_angle use_alpha use_color use_colour use_index utf8 uv_indices
syn keyword rtlangReserved uv_mapping uv_vectors v_steps variance vertex_vectors warp water_level waves width
syn keyword rtlangReserved wood wrinkles function

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
hi def link rtlangReserved Error

let b:current_syntax = "rtlang"
