# Tests: unit programs that link only what their module may use, then scripts that use the programs.
# SPDX-License-Identifier: MIT

TEST_EXTENSIONS = .sh .py
TAP_DRIVER = env AM_TAP_AWK='$(AWK)' $(SHELL) $(top_srcdir)/build-aux/tap-driver.sh
LOG_DRIVER = $(TAP_DRIVER)
SH_LOG_DRIVER = $(TAP_DRIVER)
PY_LOG_DRIVER = $(TAP_DRIVER)
SH_LOG_COMPILER = $(SHELL)
PY_LOG_COMPILER = $(PYTHON3)
AM_TESTS_ENVIRONMENT = \
  RTLANG='$(abs_top_builddir)/rtlang$(EXEEXT)'; export RTLANG; \
  RTCHECK='$(abs_top_builddir)/rtcheck$(EXEEXT)'; export RTCHECK; \
  RUN_LANG='$(abs_top_builddir)/tests/lang/run_lang'; export RUN_LANG; \
  PRINT_SCHEMA='$(abs_top_builddir)/tests/unit/print_schema'; export PRINT_SCHEMA; \
  PRINT_DIAGNOSTICS='$(abs_top_builddir)/tests/unit/print_diagnostics'; export PRINT_DIAGNOSTICS; \
  COUNT_SPHERE_TESTS='$(abs_top_builddir)/tests/unit/count_sphere_tests'; export COUNT_SPHERE_TESTS; \
  CC='$(CC)'; export CC; \
  top_srcdir='$(abs_top_srcdir)'; export top_srcdir; \
  srcdir='$(abs_srcdir)'; export srcdir;

UNIT_BASE = libbase.la
UNIT_SCENE = libscene.la libmath.la libbase.la
UNIT_TRACE = libtrace.la $(UNIT_SCENE)
UNIT_GRAMMAR = libgrammar.la libast.la libbase.la

unit_programs = \
  tests/unit/test_base_arena \
  tests/unit/test_base_diag \
  tests/unit/test_base_intern \
  tests/unit/test_base_source \
  tests/unit/test_base_suggest \
  tests/unit/test_base_text \
  tests/unit/test_math \
  tests/unit/test_noise \
  tests/unit/test_abreast \
  tests/unit/test_along \
  tests/unit/test_crackle \
  tests/unit/test_csg_bounds \
  tests/unit/test_half_spaces \
  tests/unit/test_trace_sphere \
  tests/unit/test_trace_certified \
  tests/unit/test_trace_geometry \
  tests/unit/test_trace_tree \
  tests/unit/test_trace_secondary \
  tests/unit/test_coincident \
  tests/unit/test_literal_many \
  tests/unit/test_range \
  tests/unit/test_invariance \
  tests/unit/test_build \
  tests/unit/test_refit \
  tests/unit/test_overlay \
  tests/unit/test_stack \
  tests/unit/test_study \
  tests/unit/test_trace_pixel \
  tests/unit/test_trace_parts \
  tests/unit/test_trace_csg \
  tests/unit/test_trace_elsewhere \
  tests/unit/test_trace_shapes \
  tests/unit/test_torus \
  tests/unit/test_polynomial \
  tests/unit/test_mesh \
  tests/unit/test_blob \
  tests/unit/test_isosurface \
  tests/unit/test_prism \
  tests/unit/test_revolved \
  tests/unit/test_superellipsoid \
  tests/unit/test_sweep \
  tests/unit/test_scene \
  tests/unit/test_schema \
  tests/unit/test_ast \
  tests/unit/test_grammar \
  tests/unit/test_grammar_quick \
  tests/unit/test_grammar_random \
  tests/unit/test_image \
  tests/unit/test_image_flip \
  tests/unit/test_image_png \
  tests/unit/test_image_strips \
  tests/unit/test_image_values \
  tests/unit/test_medium \
  tests/unit/test_outline \
  tests/unit/test_render \
  tests/unit/test_render_sampler \
  tests/unit/test_light_grid \
  tests/unit/test_ball_view \
  tests/unit/test_tiles \
  tests/unit/test_tiles_light \
  tests/unit/test_partial \
  tests/unit/test_race \
  tests/sampling/test_sampling \
  tests/sampling/test_sky_light \
  tests/sampling/test_share \
  tests/sampling/test_intervals \
  tests/sampling/test_small \
  tests/sampling/test_forward
check_PROGRAMS += $(unit_programs) tests/lang/run_lang tests/unit/print_schema tests/unit/print_diagnostics

unit_headers = %D%/unit/tap.h %D%/unit/random.h
tests_unit_test_base_arena_SOURCES = %D%/unit/test_base_arena.c $(unit_headers)
tests_unit_test_base_arena_LDADD = $(UNIT_BASE)
tests_unit_test_base_diag_SOURCES = %D%/unit/test_base_diag.c
tests_unit_test_base_diag_LDADD = $(UNIT_BASE)
tests_unit_test_base_intern_SOURCES = %D%/unit/test_base_intern.c
tests_unit_test_base_intern_LDADD = $(UNIT_BASE)
tests_unit_test_base_source_SOURCES = %D%/unit/test_base_source.c
tests_unit_test_base_source_LDADD = $(UNIT_BASE)
tests_unit_test_base_suggest_SOURCES = %D%/unit/test_base_suggest.c
tests_unit_test_base_suggest_LDADD = $(UNIT_BASE)
tests_unit_test_base_text_SOURCES = %D%/unit/test_base_text.c
tests_unit_test_base_text_LDADD = $(UNIT_BASE)
tests_unit_test_noise_SOURCES = %D%/unit/test_noise.c
tests_unit_test_noise_LDADD = $(UNIT_TRACE)
tests_unit_test_abreast_SOURCES = %D%/unit/test_abreast.c $(unit_headers)
tests_unit_test_abreast_LDADD = librender.la $(UNIT_TRACE)
tests_unit_test_along_SOURCES = %D%/unit/test_along.c $(unit_headers)
tests_unit_test_along_LDADD = librender.la $(UNIT_TRACE)
tests_unit_test_half_spaces_SOURCES = %D%/unit/test_half_spaces.c $(unit_headers)
tests_unit_test_half_spaces_LDADD = $(UNIT_TRACE)
tests_unit_test_crackle_SOURCES = %D%/unit/test_crackle.c $(unit_headers)
tests_unit_test_crackle_LDADD = librender.la $(UNIT_TRACE)
tests_unit_test_math_SOURCES = %D%/unit/test_math.c
tests_unit_test_math_LDADD = libmath.la libbase.la
tests_unit_test_trace_sphere_SOURCES = %D%/unit/test_trace_sphere.c
tests_unit_test_trace_sphere_LDADD = $(UNIT_TRACE)
tests_unit_test_trace_certified_SOURCES = %D%/unit/test_trace_certified.c $(unit_headers)
tests_unit_test_trace_certified_LDADD = $(UNIT_TRACE) $(MPFR_LIBS)
tests/unit/test_trace_certified.$(OBJEXT): src/study/optional.h
trace_headers = %D%/unit/trace_scenes.h $(unit_headers)
tests_unit_test_trace_geometry_SOURCES = %D%/unit/test_trace_geometry.c $(trace_headers)
tests_unit_test_trace_geometry_LDADD = $(UNIT_TRACE)
tests_unit_test_csg_bounds_SOURCES = %D%/unit/test_csg_bounds.c $(trace_headers)
tests_unit_test_csg_bounds_LDADD = $(UNIT_TRACE)
tests_unit_test_trace_elsewhere_SOURCES = %D%/unit/test_trace_elsewhere.c $(trace_headers)
tests_unit_test_trace_elsewhere_LDADD = $(UNIT_TRACE)
tests_unit_test_trace_csg_SOURCES = %D%/unit/test_trace_csg.c $(trace_headers)
tests_unit_test_trace_csg_LDADD = $(UNIT_TRACE)
tests_unit_test_trace_parts_SOURCES = %D%/unit/test_trace_parts.c $(trace_headers)
tests_unit_test_trace_parts_LDADD = $(UNIT_TRACE)
tests_unit_test_trace_shapes_SOURCES = %D%/unit/test_trace_shapes.c $(trace_headers)
tests_unit_test_trace_shapes_LDADD = $(UNIT_TRACE)
tests_unit_test_mesh_SOURCES = %D%/unit/test_mesh.c $(trace_headers)
tests_unit_test_mesh_LDADD = $(UNIT_TRACE)
tests_unit_test_torus_SOURCES = %D%/unit/test_torus.c %D%/unit/roots_oracle.h $(unit_headers)
tests_unit_test_torus_LDADD = $(UNIT_TRACE) $(MPFR_LIBS)
tests/unit/test_torus.$(OBJEXT): src/study/optional.h
tests_unit_test_blob_SOURCES = %D%/unit/test_blob.c $(unit_headers)
tests_unit_test_blob_LDADD = $(UNIT_TRACE)
tests_unit_test_isosurface_SOURCES = %D%/unit/test_isosurface.c $(unit_headers)
tests_unit_test_isosurface_LDADD = $(UNIT_TRACE)
tests_unit_test_polynomial_SOURCES = %D%/unit/test_polynomial.c %D%/unit/roots_oracle.h $(unit_headers)
tests_unit_test_polynomial_LDADD = $(UNIT_TRACE) $(MPFR_LIBS)
tests/unit/test_polynomial.$(OBJEXT): src/study/optional.h
tests_unit_test_prism_SOURCES = %D%/unit/test_prism.c $(unit_headers)
tests_unit_test_prism_LDADD = $(UNIT_TRACE)
tests_unit_test_revolved_SOURCES = %D%/unit/test_revolved.c $(unit_headers)
tests_unit_test_revolved_LDADD = $(UNIT_TRACE)
tests_unit_test_superellipsoid_SOURCES = %D%/unit/test_superellipsoid.c $(unit_headers)
tests_unit_test_superellipsoid_LDADD = $(UNIT_TRACE)
tests_unit_test_sweep_SOURCES = %D%/unit/test_sweep.c $(unit_headers)
tests_unit_test_sweep_LDADD = $(UNIT_TRACE)
tests_unit_test_trace_tree_SOURCES = %D%/unit/test_trace_tree.c $(trace_headers)
tests_unit_test_trace_tree_LDADD = $(UNIT_TRACE)
tests_unit_test_trace_secondary_SOURCES = %D%/unit/test_trace_secondary.c $(trace_headers)
tests_unit_test_trace_secondary_LDADD = $(UNIT_TRACE)
tests_unit_test_ball_view_SOURCES = %D%/unit/test_ball_view.c $(trace_headers)
tests_unit_test_ball_view_LDADD = $(UNIT_TRACE)
tests_unit_test_scene_SOURCES = %D%/unit/test_scene.c
tests_unit_test_scene_LDADD = $(UNIT_SCENE)
tests_unit_test_schema_SOURCES = %D%/unit/test_schema.c
tests_unit_test_schema_LDADD = libscene.la libast.la libmath.la libbase.la
tests_unit_print_schema_SOURCES = %D%/unit/print_schema.c
tests_unit_print_schema_LDADD = libscene.la libmath.la libbase.la
tests_unit_print_diagnostics_SOURCES = %D%/unit/print_diagnostics.c
tests_unit_print_diagnostics_LDADD = $(UNIT_BASE)
tests_unit_test_ast_SOURCES = %D%/unit/test_ast.c
tests_unit_test_ast_LDADD = libast.la libbase.la
tests_unit_test_grammar_SOURCES = %D%/unit/test_grammar.c
tests_unit_test_grammar_LDADD = $(UNIT_GRAMMAR)
tests_unit_test_grammar_quick_SOURCES = %D%/unit/test_grammar_quick.c
tests_unit_test_grammar_quick_LDADD = $(UNIT_GRAMMAR)
tests_unit_test_grammar_random_SOURCES = %D%/unit/test_grammar_random.c
tests_unit_test_grammar_random_LDADD = $(UNIT_GRAMMAR)
tests_unit_test_image_SOURCES = %D%/unit/test_image.c %D%/unit/image_forms.h
tests_unit_test_image_CPPFLAGS = $(AM_CPPFLAGS) $(PNG_CFLAGS)
tests_unit_test_image_LDADD = libimage.la libmath.la libbase.la $(PNG_LIBS)
tests_unit_test_image_flip_SOURCES = %D%/unit/test_image_flip.c $(unit_headers)
tests_unit_test_image_flip_CPPFLAGS = $(AM_CPPFLAGS) $(PNG_CFLAGS)
tests_unit_test_image_flip_LDADD = libimage.la libmath.la libbase.la $(PNG_LIBS)
tests_unit_test_image_png_SOURCES = %D%/unit/test_image_png.c
tests_unit_test_image_png_CPPFLAGS = $(AM_CPPFLAGS) $(PNG_CFLAGS)
tests_unit_test_image_png_LDADD = libimage.la libmath.la libbase.la $(PNG_LIBS)
tests_unit_test_image_strips_SOURCES = %D%/unit/test_image_strips.c $(unit_headers)
tests_unit_test_image_strips_LDADD = libimage.la libmath.la libbase.la $(PNG_LIBS)
tests_unit_test_image_values_SOURCES = %D%/unit/test_image_values.c %D%/unit/image_forms.h
tests_unit_test_image_values_CPPFLAGS = $(AM_CPPFLAGS) $(PNG_CFLAGS)
tests_unit_test_image_values_LDADD = libimage.la libmath.la libbase.la $(PNG_LIBS)
tests_unit_test_medium_SOURCES = %D%/unit/test_medium.c $(unit_headers)
tests_unit_test_medium_LDADD = librender.la $(UNIT_TRACE)
tests_unit_test_outline_SOURCES = %D%/unit/test_outline.c $(unit_headers)
tests_unit_test_outline_LDADD = librender.la $(UNIT_TRACE)
tests_unit_test_render_SOURCES = %D%/unit/test_render.c
tests_unit_test_render_LDADD = librender.la $(UNIT_TRACE)
tests_unit_test_build_SOURCES = %D%/unit/test_build.c %D%/unit/build_scenes.h $(unit_headers)
tests_unit_test_build_LDADD = libapi.la
tests_unit_test_refit_SOURCES = %D%/unit/test_refit.c $(unit_headers)
tests_unit_test_refit_LDADD = libapi.la
tests_unit_test_overlay_SOURCES = %D%/unit/test_overlay.c
tests_unit_test_overlay_LDADD = libapi.la
tests_unit_test_stack_SOURCES = %D%/unit/test_stack.c $(unit_headers)
tests_unit_test_stack_LDADD = libapi.la
tests_unit_test_coincident_SOURCES = %D%/unit/test_coincident.c $(unit_headers)
tests_unit_test_coincident_LDADD = libapi.la
tests_unit_test_literal_many_SOURCES = %D%/unit/test_literal_many.c $(unit_headers)
tests_unit_test_literal_many_LDADD = libapi.la
tests_unit_test_range_SOURCES = %D%/unit/test_range.c $(unit_headers)
tests_unit_test_range_LDADD = libapi.la
tests_unit_test_invariance_SOURCES = %D%/unit/test_invariance.c %D%/unit/scenes.h $(unit_headers)
tests_unit_test_invariance_LDADD = libapi.la
tests_unit_test_study_SOURCES = %D%/unit/test_study.c %D%/unit/scenes.h
tests_unit_test_study_LDADD = libapi.la
tests_unit_test_trace_pixel_SOURCES = %D%/unit/test_trace_pixel.c %D%/unit/scenes.h
tests_unit_test_trace_pixel_LDADD = libapi.la
tests_unit_test_light_grid_SOURCES = %D%/unit/test_light_grid.c $(unit_headers)
tests_unit_test_light_grid_LDADD = librender.la $(UNIT_TRACE)
tests_unit_test_render_sampler_SOURCES = %D%/unit/test_render_sampler.c
tests_unit_test_render_sampler_LDADD = librender.la $(UNIT_TRACE)
tests_unit_test_tiles_SOURCES = %D%/unit/test_tiles.c $(trace_headers)
tests_unit_test_tiles_LDADD = librender.la $(UNIT_TRACE)
tests_unit_test_tiles_light_SOURCES = %D%/unit/test_tiles_light.c $(trace_headers)
tests_unit_test_tiles_light_LDADD = librender.la $(UNIT_TRACE)
tests_unit_test_partial_SOURCES = %D%/unit/test_partial.c $(unit_headers)
tests_unit_test_partial_LDADD = libapi.la
tests_unit_test_race_SOURCES = %D%/unit/test_race.c src/check/race_ratio.c src/check/race_settings.c $(unit_headers)
tests_sampling_test_sampling_SOURCES = %D%/sampling/test_sampling.c %D%/sampling/scenes.h
tests_sampling_test_sampling_LDADD = libapi.la
tests_sampling_test_sky_light_SOURCES = %D%/sampling/test_sky_light.c
tests_sampling_test_sky_light_LDADD = libapi.la
tests_sampling_test_share_SOURCES = %D%/sampling/test_share.c %D%/sampling/scenes.h $(unit_headers)
tests_sampling_test_share_LDADD = libapi.la
tests_sampling_test_intervals_SOURCES = %D%/sampling/test_intervals.c %D%/sampling/grid.h %D%/sampling/scenes.h \
  $(unit_headers)
tests_sampling_test_intervals_LDADD = libapi.la
# A run may do without strata: the call that makes them is taken.
EXTRA_PROGRAMS += tests/sampling/measure
tests_sampling_measure_SOURCES = %D%/sampling/measure.c %D%/sampling/grid.h %D%/sampling/scenes.h
tests_sampling_measure_LDADD = libapi.la
tests_sampling_measure_LDFLAGS = -Wl,--wrap=share_new
tests_sampling_test_small_SOURCES = %D%/sampling/test_small.c %D%/sampling/scenes.h $(unit_headers)
tests_sampling_test_small_LDADD = libapi.la
tests_sampling_test_forward_SOURCES = %D%/sampling/test_forward.c %D%/sampling/scenes.h
tests_sampling_test_forward_LDADD = libapi.la
tests_lang_run_lang_SOURCES = %D%/lang/run_lang.c
tests_lang_run_lang_LDADD = libapi.la # for the tracer

check_PROGRAMS += tests/lang/typos
tests_lang_typos_SOURCES = %D%/lang/typos.c
tests_lang_typos_LDADD = $(tests_lang_run_lang_LDADD)

check_PROGRAMS += tests/unit/count_sphere_tests
tests_unit_count_sphere_tests_SOURCES = %D%/unit/count_sphere_tests.c
tests_unit_count_sphere_tests_CFLAGS = $(numeric_cflags)
tests_unit_count_sphere_tests_LDADD = $(UNIT_TRACE)
# The same of the vector loop, in vectors of two and of four.
count_block_programs = tests/unit/count_sphere_blocks
tests_unit_count_sphere_blocks_SOURCES = %D%/unit/count_sphere_blocks.c
tests_unit_count_sphere_blocks_CFLAGS = $(numeric_cflags)
tests_unit_count_sphere_blocks_LDADD = $(UNIT_TRACE)
if X86_64
count_block_programs += tests/unit/count_sphere_blocks_v3
tests_unit_count_sphere_blocks_v3_SOURCES = %D%/unit/count_sphere_blocks.c
tests_unit_count_sphere_blocks_v3_CFLAGS = $(numeric_cflags) -march=x86-64-v3
tests_unit_count_sphere_blocks_v3_LDADD = $(UNIT_TRACE)
endif
check_PROGRAMS += $(count_block_programs) tests/unit/count_kernels
tests_unit_count_kernels_SOURCES = %D%/unit/count_kernels.c
tests_unit_count_kernels_CFLAGS = $(numeric_cflags)
tests_unit_count_kernels_LDADD = librender.la $(UNIT_TRACE)
check_PROGRAMS += tests/fuzz/fuzz_exponents
check_PROGRAMS += tests/exact/test_exact
tests_exact_test_exact_SOURCES = %D%/exact/test_exact.c %D%/exact/families.c %D%/exact/families.h \
  %D%/exact/reference.c %D%/exact/reference.h $(unit_headers)
tests_exact_test_exact_LDADD = libapi.la $(MPFR_LIBS)
tests/exact/test_exact.$(OBJEXT) tests/exact/reference.$(OBJEXT): src/study/optional.h
tests_fuzz_fuzz_exponents_SOURCES = %D%/fuzz/fuzz_exponents.c $(unit_headers)
tests_fuzz_fuzz_exponents_LDADD = libapi.la

test_scripts = \
  %D%/lang/check_cases.sh \
  %D%/check-layers.py \
  %D%/check-headers.py \
  %D%/check-globals.py \
  %D%/check-draws.py \
  %D%/check-diagnostics.py \
  %D%/check-docs.py \
  %D%/check-tour.py \
  %D%/check-readme.py \
  %D%/check-editors.py \
  %D%/format/check_format.py \
  %D%/golden/check_golden.py \
  %D%/golden/check_gallery.py \
  %D%/system/check_growth.py \
  %D%/system/check_grid.py \
  %D%/system/check_color.py \
  %D%/system/check_stack.py \
  %D%/system/check_literals.py \
  %D%/system/check_messages.py \
  %D%/system/check_povray_options.py \
  %D%/system/check_memory.py \
  %D%/system/check_planes.py \
  %D%/system/check_confinement.py \
  %D%/system/check_text.py \
  %D%/system/check_hostile.py \
  %D%/system/run_system.py \
  %D%/system/check_image_files.py \
  %D%/system/check_frames.py \
  %D%/system/check_lenient.py \
  %D%/system/check_lsp.py \
  %D%/system/check_rerun.py \
  %D%/system/check_share.py \
  %D%/system/check_ranks.py \
  %D%/system/check_shared_scene.py \
  %D%/system/check_install.py \
  %D%/system/check_python.py \
  %D%/system/check_strip.py \
  %D%/system/check_supply.py \
  %D%/system/check_trace.py \
  %D%/system/check_library_path.py \
  %D%/system/check_instructions.py \
  %D%/system/check_rtcheck.sh \
  %D%/system/check_sampling.py \
  %D%/system/check_blur_stop.py \
  %D%/system/check_stability.py \
  %D%/system/check_study.py \
  %D%/system/check_aarch64.py \
  %D%/system/check_disable_study.py \
  %D%/system/check_report.py \
  %D%/system/check_watch.py \
  %D%/povray/check_pictures.py \
  %D%/povray/check_place.py \
  %D%/povray/check_apart.py \
  %D%/povray/check_blur.sh \
  %D%/povray/check_alpha.py \
  %D%/povray/check_alpha_samples.py \
  %D%/povray/check_antialias.py \
  %D%/povray/check_ase.py \
  %D%/povray/check_callers.py \
  %D%/povray/check_vapory.py \
  %D%/povray/check_cameras.py \
  %D%/povray/check_jitter.py \
  %D%/povray/check_lens.py \
  %D%/povray/check_area_lights.py \
  %D%/povray/check_pairs.py \
  %D%/povray/check_scenes.py \
  %D%/povray/check_standard_names.py \
  %D%/povray/check_includes.py \
  %D%/povray/check_lang.py \
  %D%/povray/check_trace.py \
  %D%/povray/check_debug.py \
  %D%/povray/check_programs.py \
  %D%/povray/check_colors.py \
  %D%/povray/check_own_includes.py \
  %D%/povray/check_exporters.py \
  %D%/povray/check_survey.py

.PHONY: check-growth
check-long: check-growth
check-growth: rtlang$(EXEEXT)
	$(AM_TESTS_ENVIRONMENT) CHECK_LONG=1 $(PYTHON3) $(top_srcdir)/tests/system/check_growth.py

# For who runs some of them: make check TESTS="...".
.PHONY: list-tests
list-tests:
	@printf '%s\n' $(TESTS)

# The run ends with what it left out, and why.
check-local: check-TESTS
	@test ! -e $(TEST_SUITE_LOG) || $(AWK) -f $(srcdir)/%D%/skipped.awk $(TEST_SUITE_LOG)
EXTRA_DIST += %D%/skipped.awk %D%/coverage %D%/coverage.py %D%/lint

TESTS += $(unit_programs) tests/fuzz/fuzz_exponents tests/exact/test_exact tests/lang/typos $(test_scripts)
AM_CPPFLAGS += -I$(srcdir)/tests
# Whole folders only where nothing is built; the rest file by file.
lang_cases = \
  %D%/lang/arrays.test \
  %D%/lang/bicubic.test \
  %D%/lang/camera.test \
  %D%/lang/colours.test \
  %D%/lang/declare.test \
  %D%/lang/default.test \
  %D%/lang/expressions.test \
  %D%/lang/extents.test \
  %D%/lang/faults.test \
  %D%/lang/files.test \
  %D%/lang/finish.test \
  %D%/lang/functions.test \
  %D%/lang/height_field.test \
  %D%/lang/hints.test \
  %D%/lang/includes.test \
  %D%/lang/interior.test \
  %D%/lang/pattern_slope.test \
  %D%/lang/rainbow.test \
  %D%/lang/lenient.test \
  %D%/lang/light.test \
  %D%/lang/limits.test \
  %D%/lang/loops.test \
  %D%/lang/macros.test \
  %D%/lang/mesh.test \
  %D%/lang/normal.test \
  %D%/lang/pattern.test \
  %D%/lang/pictures.test \
  %D%/lang/pigment.test \
  %D%/lang/plane.test \
  %D%/lang/range.test \
  %D%/lang/seeded_faults.test \
  %D%/lang/settings.test \
  %D%/lang/isosurface.test \
  %D%/lang/julia.test \
  %D%/lang/parametric.test \
  %D%/lang/given_surfaces.test \
  %D%/lang/ovus.test \
  %D%/lang/shapes.test \
  %D%/lang/sweep.test \
  %D%/lang/sky.test \
  %D%/lang/sphere.test \
  %D%/lang/splice.test \
  %D%/lang/splines.test \
  %D%/lang/strings.test \
  %D%/lang/suggestions.test \
  %D%/lang/surface.test \
  %D%/lang/texture.test \
  %D%/lang/transforms.test \
  %D%/lang/union.test \
  %D%/lang/warnings.test
EXTRA_DIST += \
  $(test_scripts) \
  $(lang_cases) \
  %D%/format/layout.scn \
  %D%/format/layout.expected \
  %D%/golden \
  %D%/system \
  %D%/povray

# Rewrite what the tests hold as expected; look at the difference before it is committed.
.PHONY: update-golden update-docs update-measured
update-golden: rtlang$(EXEEXT)
	$(AM_TESTS_ENVIRONMENT) UPDATE_GOLDEN=1 $(PYTHON3) $(top_srcdir)/tests/golden/check_golden.py
	$(AM_TESTS_ENVIRONMENT) UPDATE_GOLDEN=1 $(PYTHON3) $(top_srcdir)/tests/golden/check_gallery.py
update-docs: rtlang$(EXEEXT) tests/unit/print_schema$(EXEEXT) tests/unit/print_diagnostics$(EXEEXT)
	$(AM_TESTS_ENVIRONMENT) UPDATE_DOCS=1 $(PYTHON3) $(top_srcdir)/tests/check-docs.py
	$(AM_TESTS_ENVIRONMENT) UPDATE_DOCS=1 $(PYTHON3) $(top_srcdir)/tests/check-tour.py
	$(AM_TESTS_ENVIRONMENT) UPDATE_DOCS=1 $(PYTHON3) $(top_srcdir)/tests/check-editors.py
# What docs/language.md tells of differences from POV-Ray, which must be there.
update-measured: rtlang$(EXEEXT) rtcheck$(EXEEXT)
	$(AM_TESTS_ENVIRONMENT) $(PYTHON3) $(top_srcdir)/tests/povray/check_apart.py --update
	$(AM_TESTS_ENVIRONMENT) $(PYTHON3) $(top_srcdir)/tests/povray/check_antialias.py --update
	$(AM_TESTS_ENVIRONMENT) $(PYTHON3) $(top_srcdir)/tests/povray/check_callers.py --update

# What takes too long for every day.
.PHONY: check-long
check-long: rtlang$(EXEEXT) rtcheck$(EXEEXT) tests/unit/test_trace_certified$(EXEEXT) \
  tests/unit/test_trace_secondary$(EXEEXT) tests/unit/test_range$(EXEEXT) tests/unit/test_invariance$(EXEEXT) \
  tests/unit/test_mesh$(EXEEXT) tests/fuzz/fuzz_exponents$(EXEEXT) tests/exact/test_exact$(EXEEXT) \
  tests/unit/test_partial$(EXEEXT) tests/unit/test_prism$(EXEEXT) \
  tests/unit/test_revolved$(EXEEXT) tests/unit/test_superellipsoid$(EXEEXT) tests/unit/test_sweep$(EXEEXT)
	tests/unit/test_trace_certified$(EXEEXT) 1000000
	CHECK_LONG=1 tests/unit/test_prism$(EXEEXT)
	CHECK_LONG=1 tests/unit/test_revolved$(EXEEXT)
	CHECK_LONG=1 tests/unit/test_superellipsoid$(EXEEXT)
	CHECK_LONG=1 tests/unit/test_sweep$(EXEEXT)
	tests/unit/test_trace_secondary$(EXEEXT) 1000000
	tests/unit/test_mesh$(EXEEXT) 1700000
	tests/unit/test_range$(EXEEXT) 20000
	tests/fuzz/fuzz_exponents$(EXEEXT) 10000
	tests/exact/test_exact$(EXEEXT) 100000
	$(AM_TESTS_ENVIRONMENT) tests/unit/test_invariance$(EXEEXT) all
	$(AM_TESTS_ENVIRONMENT) CHECK_LONG=1 $(PYTHON3) $(top_srcdir)/tests/system/check_stability.py
	$(AM_TESTS_ENVIRONMENT) CHECK_LONG=1 $(PYTHON3) $(top_srcdir)/tests/system/check_hostile.py
	$(AM_TESTS_ENVIRONMENT) MEMORY_ALL=1 $(PYTHON3) $(top_srcdir)/tests/system/check_memory.py
	$(AM_TESTS_ENVIRONMENT) CHECK_LONG=1 $(PYTHON3) $(top_srcdir)/tests/system/check_study.py
	$(AM_TESTS_ENVIRONMENT) CHECK_LONG=1 $(PYTHON3) $(top_srcdir)/tests/system/check_aarch64.py
	$(AM_TESTS_ENVIRONMENT) CHECK_LONG=1 $(PYTHON3) $(top_srcdir)/tests/system/check_disable_study.py
	$(AM_TESTS_ENVIRONMENT) $(PYTHON3) $(top_srcdir)/tests/povray/check_pairs.py 500 "$$(date +%s)"
	$(AM_TESTS_ENVIRONMENT) $(PYTHON3) $(top_srcdir)/tests/povray/check_scenes.py 5000
	$(AM_TESTS_ENVIRONMENT) $(PYTHON3) $(top_srcdir)/tests/povray/check_programs.py 2000 "$$(date +%s)"
	$(AM_TESTS_ENVIRONMENT) $(PYTHON3) $(top_srcdir)/tests/povray/check_include_names.py
	$(AM_TESTS_ENVIRONMENT) $(PYTHON3) $(top_srcdir)/tests/system/check_literals.py 5000 "$$(date +%s)"
	$(AM_TESTS_ENVIRONMENT) EXPORTERS_LONG=1 $(PYTHON3) $(top_srcdir)/tests/povray/check_exporters.py
	$(AM_TESTS_ENVIRONMENT) $(PYTHON3) $(top_srcdir)/tests/system/check_share.py kills 1000
	$(AM_TESTS_ENVIRONMENT) CHECK_LONG=1 $(PYTHON3) $(top_srcdir)/tests/system/check_ranks.py
	$(AM_TESTS_ENVIRONMENT) CHECK_LONG=1 $(PYTHON3) $(top_srcdir)/tests/system/check_shared_scene.py
	TURNS=3000 tests/unit/test_partial$(EXEEXT)
	$(AM_TESTS_ENVIRONMENT) FORMAT_SEED="$$(date +%s)" $(PYTHON3) $(top_srcdir)/tests/format/check_format.py

# Error against samples, with all seeds and scenes, and photons.
.PHONY: check-sampling
check-long: check-sampling
check-sampling: tests/sampling/test_sampling$(EXEEXT) tests/sampling/test_intervals$(EXEEXT) \
		tests/sampling/test_small$(EXEEXT) tests/sampling/test_share$(EXEEXT) tests/sampling/test_forward$(EXEEXT)
	tests/sampling/test_sampling$(EXEEXT) long
	tests/sampling/test_intervals$(EXEEXT) long
	tests/sampling/test_small$(EXEEXT) long
	tests/sampling/test_share$(EXEEXT) long
	tests/sampling/test_forward$(EXEEXT) long

# Both install from the same folder, where libtool links anew: one after the other.
%D%/system/check_strip.log: %D%/system/check_install.log
