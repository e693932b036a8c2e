# Grammar: flex and bison sources, seen by others through grammar.h only.
# SPDX-License-Identifier: MIT

AM_YFLAGS = -d -Wall -Wno-yacc
noinst_LTLIBRARIES += libgrammar.la
libgrammar_la_SOURCES = \
  %D%/actions.h \
  %D%/block_template.c \
  %D%/directives.c \
  %D%/fragment.c \
  %D%/grammar.c \
  %D%/grammar.h \
  %D%/hints.c \
  %D%/lexer.h \
  %D%/lexer.l \
  %D%/messages.c \
  %D%/parser.y \
  %D%/quick.c \
  %D%/recovery.c \
  %D%/statements.c \
  %D%/statements.h \
  %D%/statements_many.c \
  %D%/template.c \
  %D%/template.h \
  %D%/tokens.c \
  %D%/window.c
# The generated header is included by files of this folder only, so the rule stands here by hand.
%D%/directives.lo %D%/fragment.lo %D%/grammar.lo %D%/hints.lo %D%/block_template.lo %D%/lexer.lo %D%/messages.lo %D%/statements_many.lo %D%/quick.lo %D%/recovery.lo %D%/statements.lo %D%/tokens.lo %D%/window.lo: %D%/parser.h
MAINTAINERCLEANFILES = %D%/parser.c %D%/parser.h %D%/lexer.c
