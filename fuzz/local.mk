# Fuzzing: targets that a fuzzer gives any bytes. Each is built twice: with fuzz/replay.c for `make check`, and, where
# `make fuzz` or OSS-Fuzz ask for it, with a fuzzer.
# SPDX-License-Identifier: MIT

# Given on the command line of make: -fsanitize=fuzzer, or the library of another fuzzer.
LIB_FUZZING_ENGINE =
fuzz_ini_sources = src/cli/povray_ini.c src/cli/povray_read.c src/cli/povray_table.c src/cli/povray_value.c \
  src/cli/terminal.c
fuzz_replays = fuzz/replay_grammar fuzz/replay_scene fuzz/replay_dump fuzz/replay_picture fuzz/replay_ini \
  fuzz/replay_partial fuzz/replay_world fuzz/replay_calls fuzz/replay_programs fuzz/replay_tree fuzz/replay_reader
fuzz_targets = fuzz/fuzz_grammar fuzz/fuzz_scene fuzz/fuzz_dump fuzz/fuzz_picture fuzz/fuzz_ini fuzz/fuzz_partial \
  fuzz/fuzz_world fuzz/fuzz_calls fuzz/fuzz_programs fuzz/fuzz_tree fuzz/fuzz_reader
check_PROGRAMS += $(fuzz_replays)
EXTRA_PROGRAMS += $(fuzz_targets)
fuzz_replay_grammar_SOURCES = %D%/fuzz_grammar.c %D%/fuzz.h %D%/replay.c
fuzz_replay_grammar_LDADD = libapi.la
fuzz_replay_scene_SOURCES = %D%/fuzz_scene.c %D%/fuzz.h %D%/replay.c
fuzz_replay_scene_LDADD = libapi.la
fuzz_replay_dump_SOURCES = %D%/fuzz_dump.c %D%/fuzz.h %D%/replay.c
fuzz_replay_dump_LDADD = libapi.la
fuzz_replay_world_SOURCES = %D%/fuzz_world.c %D%/fuzz.h %D%/replay.c
fuzz_replay_world_LDADD = libapi.la
fuzz_replay_calls_SOURCES = %D%/fuzz_calls.c %D%/fuzz.h %D%/replay.c
fuzz_replay_calls_LDADD = libapi.la
fuzz_replay_programs_SOURCES = %D%/fuzz_programs.c %D%/fuzz.h %D%/replay.c
fuzz_replay_programs_LDADD = libapi.la
fuzz_replay_tree_SOURCES = %D%/fuzz_tree.c %D%/fuzz.h %D%/replay.c tests/unit/trace_scenes.h tests/unit/random.h
fuzz_replay_tree_LDADD = libtrace.la libscene.la libmath.la libbase.la
fuzz_replay_reader_SOURCES = %D%/fuzz_reader.c %D%/fuzz.h %D%/fuzz_samples.h %D%/replay.c
fuzz_replay_reader_LDADD = libimage.la libmath.la libbase.la
fuzz_replay_picture_SOURCES = %D%/fuzz_picture.c %D%/fuzz.h %D%/fuzz_samples.h %D%/replay.c
fuzz_replay_picture_LDADD = libimage.la libmath.la libbase.la
fuzz_replay_ini_SOURCES = %D%/fuzz_ini.c %D%/fuzz.h %D%/replay.c $(fuzz_ini_sources)
fuzz_replay_ini_LDADD = libapi.la
fuzz_replay_partial_SOURCES = %D%/fuzz_partial.c %D%/fuzz.h %D%/replay.c
fuzz_replay_partial_LDADD = libshare.la libimage.la libbase.la
fuzz_fuzz_grammar_SOURCES = %D%/fuzz_grammar.c %D%/fuzz.h
fuzz_fuzz_grammar_LDADD = libapi.la $(LIB_FUZZING_ENGINE)
fuzz_fuzz_scene_SOURCES = %D%/fuzz_scene.c %D%/fuzz.h
fuzz_fuzz_scene_LDADD = libapi.la $(LIB_FUZZING_ENGINE)
fuzz_fuzz_dump_SOURCES = %D%/fuzz_dump.c %D%/fuzz.h
fuzz_fuzz_dump_LDADD = libapi.la $(LIB_FUZZING_ENGINE)
fuzz_fuzz_world_SOURCES = %D%/fuzz_world.c %D%/fuzz.h
fuzz_fuzz_world_LDADD = libapi.la $(LIB_FUZZING_ENGINE)
fuzz_fuzz_calls_SOURCES = %D%/fuzz_calls.c %D%/fuzz.h
fuzz_fuzz_calls_LDADD = libapi.la $(LIB_FUZZING_ENGINE)
fuzz_fuzz_programs_SOURCES = %D%/fuzz_programs.c %D%/fuzz.h
fuzz_fuzz_programs_LDADD = libapi.la $(LIB_FUZZING_ENGINE)
fuzz_fuzz_tree_SOURCES = %D%/fuzz_tree.c %D%/fuzz.h tests/unit/trace_scenes.h tests/unit/random.h
fuzz_fuzz_tree_LDADD = libtrace.la libscene.la libmath.la libbase.la $(LIB_FUZZING_ENGINE)
# Modules that read pictures are loaded, and call the fuzzer for what they cover.
fuzz_fuzz_reader_SOURCES = %D%/fuzz_reader.c %D%/fuzz.h %D%/fuzz_samples.h
fuzz_fuzz_reader_LDADD = libimage.la libmath.la libbase.la $(LIB_FUZZING_ENGINE)
fuzz_fuzz_reader_LDFLAGS = -export-dynamic
fuzz_fuzz_picture_SOURCES = %D%/fuzz_picture.c %D%/fuzz.h %D%/fuzz_samples.h
fuzz_fuzz_picture_LDADD = libimage.la libmath.la libbase.la $(LIB_FUZZING_ENGINE)
fuzz_fuzz_picture_LDFLAGS = -export-dynamic
fuzz_fuzz_ini_SOURCES = %D%/fuzz_ini.c %D%/fuzz.h $(fuzz_ini_sources)
fuzz_fuzz_ini_LDADD = libapi.la $(LIB_FUZZING_ENGINE)
fuzz_fuzz_partial_SOURCES = %D%/fuzz_partial.c %D%/fuzz.h
fuzz_fuzz_partial_LDADD = libshare.la libimage.la libbase.la $(LIB_FUZZING_ENGINE)

TESTS += %D%/replay.py
.PHONY: fuzz-replays
fuzz-replays: $(fuzz_replays) rtlang_jpeg.la
EXTRA_DIST += %D%/replay.py %D%/make_seeds.py %D%/make_dictionary.py %D%/run %D%/corpus %D%/oss-fuzz

# What a fuzzer needs beside a build for it: programs, dictionaries and seeds.
.PHONY: fuzz fuzz-build
fuzz-build: $(fuzz_targets) $(pkglib_LTLIBRARIES) tests/unit/print_schema$(EXEEXT)
	tests/unit/print_schema$(EXEEXT) | $(PYTHON3) $(srcdir)/%D%/make_dictionary.py $(srcdir) fuzz
	$(PYTHON3) $(srcdir)/%D%/make_seeds.py $(srcdir) fuzz/seeds

# Each target for SECONDS, in a build of its own with clang in the folder build-fuzz. Sources are copied: those that a
# build was configured in cannot be built in another folder.
SECONDS = 60
fuzz:
	$(MKDIR_P) build-fuzz
	$(MAKE) $(AM_MAKEFLAGS) distdir distdir=build-fuzz/source
	$(SHELL) $(srcdir)/%D%/run '$(abs_builddir)/build-fuzz/source' $(SECONDS)

clean-local: clean-fuzz
.PHONY: clean-fuzz
clean-fuzz:
	rm -rf fuzz/seeds fuzz/text.dict fuzz/ini.dict
CLEANFILES += $(fuzz_targets)
