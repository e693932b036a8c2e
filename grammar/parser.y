// The grammar of the scene language: tokens in, AST out.
//
// It knows expressions, statements and generic blocks (`word { items }`), never kinds of objects. Every action is one
// ast_* call or one list append; a completed top-level item goes to the client. After a fault the token stream skips to
// a place where reading can continue and says so by the token RESYNC (see tokens.c).
//
// SPDX-License-Identifier: MIT
%require "3.8"
%define api.pure full
%define api.prefix {grammar_yy}
%define api.token.prefix {TOKEN_}
%define api.location.type {Span}
%define parse.error custom
%define parse.lac full
%locations
%expect 0
%param {GrammarState *state}

%code requires {
#include "ast/ast.h"
#include "grammar/lexer.h"
}

%code provides {
int grammar_yylex(GRAMMAR_YYSTYPE *value, Span *span, GrammarState *state);
}

%union {
    Symbol symbol;
    double number;
    AstNode *node;
    AstList list;
}

%code {
#include "grammar/actions.h"

#define FINISH(node)                                                                                                   \
    do {                                                                                                               \
        grammar_finish(state, (node), yychar != TOKEN_GRAMMAR_YYEMPTY);                                                      \
        YYACCEPT;                                                                                                      \
    } while (false)

// As span_join, for spans that all exist; an empty rule stands at the end of what came before.
#define YYLLOC_DEFAULT(current, rhs, count)                                                                            \
    ((current) = (Span){(count) > 0 ? YYRHSLOC(rhs, 1).begin : YYRHSLOC(rhs, 0).end, YYRHSLOC(rhs, count).end})

// Most texts nest a few levels; the limit is reached only after the AST's own depth limit, or by parentheses.
#define YYMAXDEPTH 20000
#define YYINITDEPTH 100 // on the stack; what is deeper is moved from there

static void grammar_yyerror(Span *at, GrammarState *state, const char *message);
}

// What is parsed: a whole text, or a fragment of one.
%token START_TEXT "a text" START_ITEM "an item" START_DIRECTIVE "a directive"
%token START_CONDITION "a condition" START_SUBJECT "a subject" START_RANGE "a range" START_FOR "the head of a loop"
%token START_FULL "an expression" START_MACRO "the head of a macro" START_ARGUMENTS "arguments"
%token END_OF_FILE 0 "the end of the file"
%token INVALID "an unreadable token"
%token RESYNC "the next item"
%token <number> NUMBER "a number"
%token <node> VECTOR "a vector of numbers"
%token <list> ITEMS "the items of a block"
%token <symbol> STRING "a string"
%token <symbol> NAME "a name" CONSTANT "a constant" BUILTIN "a function"
%token <symbol> WORD "a word" COLOUR "a colour word" TEXTURE "texture"
%token <symbol> DIRECTIVE_WORD "a directive's word" DEPRECATED "deprecated"
%token <symbol> ARRAY "array" FUNCTION "function" TERM "xyz"
%token LESS_EQUAL "<=" GREATER_EQUAL ">=" NOT_EQUAL "!="
%token HASH_DECLARE "#declare" HASH_LOCAL "#local" HASH_UNDEF "#undef"
%token HASH_IF "#if" HASH_IFDEF "#ifdef" HASH_IFNDEF "#ifndef" HASH_ELSEIF "#elseif" HASH_ELSE "#else" HASH_END "#end"
%token HASH_SWITCH "#switch" HASH_CASE "#case" HASH_RANGE "#range" HASH_BREAK "#break"
%token HASH_WHILE "#while" HASH_FOR "#for" HASH_MACRO "#macro"
%token HASH_INCLUDE "#include" HASH_DEFAULT "#default" HASH_VERSION "#version"
%token HASH_DEBUG "#debug" HASH_WARNING "#warning" HASH_ERROR "#error" HASH_RENDER "#render"
%token HASH_STATISTICS "#statistics"
%token HASH_FOPEN "#fopen" HASH_FCLOSE "#fclose" HASH_READ "#read" HASH_WRITE "#write"

%type <node> item term block layer entry array function field_size directive simple declare assignment conditional message file case
%type <node> otherwise parameter
%type <node> value initialiser unreadable
%type <node> full logic relation sum indexed inline include target subject condition
%type <list> items entry_items body block_body components arguments operands colour colour_open layers sizes rows
%type <list> parameters names bounds written cases else_part function_body
%type <symbol> word block_word mode member reserved

%printer { fprintf(yyo, "symbol %u", (unsigned)$$); } <symbol>
%printer { fprintf(yyo, "%g", $$); } <number>
%printer { fprintf(yyo, "%s", ast_kind_name((AstKind)$$->kind)); } <node>
%printer { fprintf(yyo, "%u elements", (unsigned)$$.count); } <list>

// Two expressions side by side: whatever can continue the first one does, as in POV-Ray.
%precedence JUXTAPOSED
%precedence '(' '[' '<' ';' COLOUR TEXTURE
%left '+' '-'
%left '*' '/'
%precedence UNARY
%precedence '.'

%start start

%%

// Each fragment ends itself, so that no token after it is read where none is needed.
start:
  START_TEXT text
| START_ITEM item                   { FINISH($item); } rest
| START_FULL full                   { FINISH($full); } more
| START_DIRECTIVE simple            { FINISH($simple); } rest
| START_CONDITION '(' full ')'      { FINISH($full); }
| START_SUBJECT '(' subject ')'     { FINISH($subject); }
| START_RANGE '(' sum[low] comma sum[high] ')'
    { FINISH(LISTS(RANGE, NONE, SYMBOL_NONE, @$, ONE($low), ONE($high), EMPTY)); }
| START_FOR '(' NAME comma bounds ')'
    { FINISH(LISTS(FOR, NONE, SYMBOL_NONE, @$, ONE(LEAF(NAME, $NAME, @NAME)), $bounds, EMPTY)); }
| START_MACRO NAME '(' names comma ')' { FINISH(LISTS(MACRO, NONE, $NAME, @$, $names, EMPTY, EMPTY)); }
| START_MACRO NAME '(' ')'          { FINISH(LISTS(MACRO, NONE, $NAME, @$, EMPTY, EMPTY, EMPTY)); }
| START_ARGUMENTS '(' arguments comma ')' { FINISH(LIST(CALL, SYMBOL_NONE, @$, $arguments)); }
| START_ARGUMENTS '(' ')'           { FINISH(LIST(CALL, SYMBOL_NONE, @$, EMPTY)); }
;

// What may follow a fragment; never read.
more:
  %empty
| ','
| ';'
;

rest:
  %empty
| item
| ','
| ';'
| '}'
| ']'
| ')'
;

// ---- Items: the top level, blocks and the bodies of directives hold the same.

text:
  top
| top ','                           { grammar_end_in_comma(state, @2); }
;

top:
  %empty
| top item
    {
        bool has_lookahead = yychar != TOKEN_GRAMMAR_YYEMPTY;
        bool may_be_one_of_many = has_lookahead && $item->kind == AST_CALL && state->statements != NULL;
        if (!grammar_emit(state, $item, has_lookahead)) {
            YYABORT;
        }
        if (may_be_one_of_many && grammar_reread_statements(state)) {
            yyclearin;
        }
    }
| top ',' item
    { if (!grammar_emit(state, ast_flag($item, AST_AFTER_COMMA), yychar != TOKEN_GRAMMAR_YYEMPTY)) { YYABORT; } }
| top error RESYNC                  { yyerrok; }
;

items:
  item                              { $$ = ONE($item); }
| items item                        { $$ = ast_append($1, $item); }
| items ',' item                    { $$ = ast_append_after_comma($1, $item); }
| error RESYNC                      { $$ = EMPTY; yyerrok; }
| items error RESYNC                { $$ = $1; yyerrok; }
;

block_body:
  %empty                            { $$ = EMPTY; }
| items                             { $$ = $items; }
| items ','                         { $$ = ast_flag_last($items, AST_BEFORE_COMMA); }
;

body:
  block_body                        { $$ = $block_body; }
| items ';'                         { $$ = ast_flag_last($items, AST_BEFORE_SEMICOLON); }
| ',' items                         { $$ = ast_flag_first($items, AST_AFTER_COMMA); }
| ',' items ','                     { $$ = ast_flag_first(ast_flag_last($items, AST_BEFORE_COMMA), AST_AFTER_COMMA); }
;

item:
  sum                               %prec JUXTAPOSED { $$ = $sum; }
| word                              { $$ = LEAF(WORD, $word, @$); }
| block                             { $$ = $block; }
| entry                             { $$ = $entry; }
| term                              { $$ = $term; }
| array                             { $$ = $array; }
| function                          { $$ = $function; }
| directive                         { $$ = $directive; }
;

word: WORD | COLOUR | TEXTURE;

block:
  block_word '{' block_body '}'     { LEARN($3, @2, @4); $$ = LIST(BLOCK, $block_word, @$, $block_body); }
| block_word ITEMS                  { $$ = LIST(BLOCK, $block_word, @$, $ITEMS); }
| layer                             { $$ = $layer; }
;

// A name in the place of a block's word is a slip of the pen that the evaluator explains better.
block_word: WORD | NAME;

layer:
  TEXTURE '{' block_body '}'        { LEARN($3, @2, @4); $$ = LIST(BLOCK, $TEXTURE, @$, $block_body); }
| TEXTURE ITEMS                     { $$ = LIST(BLOCK, $TEXTURE, @$, $ITEMS); }
;

entry:
  '[' entry_items ']'               { $$ = LIST(ENTRY, SYMBOL_NONE, @$, $entry_items); }
| '[' entry_items ',' ']'
    { $$ = LIST(ENTRY, SYMBOL_NONE, @$, ast_flag_last($entry_items, AST_BEFORE_COMMA)); }
| '[' ']'                           { $$ = LIST(ENTRY, SYMBOL_NONE, @$, EMPTY); }
;

term:
  TERM '(' sum[x] comma sum[y] comma sum[z] ')' ':' sum[factor]   %prec JUXTAPOSED
    { $$ = LISTS(TERM, NONE, $TERM, @$, ast_append(ast_append(ONE($x), $y), $z), ONE($factor), EMPTY); }
;

// As items, but after a fault the block around the entry continues, not the entry.
entry_items:
  item                              { $$ = ONE($item); }
| entry_items item                  { $$ = ast_append($1, $item); }
| entry_items ',' item              { $$ = ast_append_after_comma($1, $item); }
;

// ---- Values: the right side of a declaration, an argument, an element.

value:
  sum                               %prec JUXTAPOSED { $$ = $sum; }
| colour                            %prec JUXTAPOSED { $$ = LIST(SEQUENCE, SYMBOL_NONE, @$, $colour); }
| layers                            %prec JUXTAPOSED { $$ = LIST(SEQUENCE, SYMBOL_NONE, @$, $layers); }
| layer                             %prec JUXTAPOSED { $$ = $layer; }
| block_word '{' block_body '}'     { LEARN($3, @2, @4); $$ = LIST(BLOCK, $block_word, @$, $block_body); }
| block_word ITEMS                  { $$ = LIST(BLOCK, $block_word, @$, $ITEMS); }
| array                             { $$ = $array; }
| function                          { $$ = $function; }
| inline                            { $$ = $inline; }
;

arguments:
  value                             { $$ = ONE($value); }
| arguments value                   { $$ = ast_append($1, ast_flag($value, AST_WITHOUT_COMMA)); }
| arguments ',' value               { $$ = ast_append($1, $value); }
;

colour: colour_open sum             %prec JUXTAPOSED { $$ = ast_append($colour_open, $sum); };

colour_open:
  COLOUR                            { $$ = ONE(LEAF(WORD, $COLOUR, @$)); }
| colour_open COLOUR                { $$ = ast_append($1, LEAF(WORD, $COLOUR, @COLOUR)); }
| colour COLOUR                     { $$ = ast_append($1, LEAF(WORD, $COLOUR, @COLOUR)); }
;

layers:
  layer[first] layer[second]        { $$ = ast_append(ONE($first), $second); }
| layers layer                      { $$ = ast_append($1, $layer); }
;

array:
  ARRAY sizes                       %prec JUXTAPOSED { $$ = LIST(ARRAY, SYMBOL_NONE, @$, $sizes); }
| ARRAY sizes initialiser           { $$ = LISTS(ARRAY, NONE, SYMBOL_NONE, @$, $sizes, ONE($initialiser), EMPTY); }
;

sizes:
  '[' sum ']'                       { $$ = ONE($sum); }
| sizes '[' sum ']'                 { $$ = ast_append($1, $sum); }
;

initialiser:
  '{' arguments comma '}'           { $$ = LIST(INITIALISER, SYMBOL_NONE, @$, $arguments); }
| '{' rows comma '}'                { $$ = LIST(INITIALISER, SYMBOL_NONE, @$, $rows); }
| '{' '}'                           { $$ = LIST(INITIALISER, SYMBOL_NONE, @$, EMPTY); }
| '{' error RESYNC '}'              { $$ = LIST(INITIALISER, SYMBOL_NONE, @$, EMPTY); yyerrok; }
;

rows:
  initialiser                       { $$ = ONE($initialiser); }
| rows initialiser                  { $$ = ast_append($1, $initialiser); }
| rows ',' initialiser              { $$ = ast_append($1, $initialiser); }
;

function:
  FUNCTION '{' function_body '}'
    { $$ = LISTS(FUNCTION, NONE, SYMBOL_NONE, @$, EMPTY, $function_body, EMPTY); }
| FUNCTION '(' parameters ')' '{' function_body '}'
    { $$ = LISTS(FUNCTION, NONE, SYMBOL_NONE, @$, $parameters, $function_body, EMPTY); }
| FUNCTION field_size[w] ',' field_size[h] '{' function_body '}'
    { $$ = LISTS(FUNCTION, NONE, SYMBOL_NONE, @$, EMPTY, $function_body, ast_append(ONE($w), $h)); }
;

// How many values a field has along one side. One in parentheses would look like a list of parameters.
field_size:
  NUMBER                            { $$ = ast_number(&state->builder, $NUMBER, @$); }
| NAME                              { $$ = grammar_name(state, $NAME, @$); }
| field_size[l] '+' field_size[r]   { $$ = FOLD(BINARY(ADD, @$, $l, $r)); }
| field_size[l] '-' field_size[r]   { $$ = FOLD(BINARY(SUB, @$, $l, $r)); }
| field_size[l] '*' field_size[r]   { $$ = FOLD(BINARY(MUL, @$, $l, $r)); }
| field_size[l] '/' field_size[r]   { $$ = FOLD(BINARY(DIV, @$, $l, $r)); }
;

function_body:
  logic                             { $$ = ONE($logic); }
| inline                            { $$ = ONE($inline); }
| block                             { $$ = ONE($block); }
| error RESYNC                      { $$ = EMPTY; yyerrok; }
;

parameters:
  parameter                         { $$ = ONE($parameter); }
| parameters parameter              { $$ = ast_append($1, $parameter); }
| parameters ',' parameter          { $$ = ast_append($1, $parameter); }
;

parameter:
  NAME                              { $$ = grammar_name(state, $NAME, @$); }
| CONSTANT                          { $$ = LEAF(NAME, $CONSTANT, @$); }
;

comma:
  %empty                            %prec JUXTAPOSED
| ','
;

// ---- Directives.

directive:
  simple                            { $$ = $simple; }
| conditional                       { $$ = $conditional; }
| HASH_BREAK                        { $$ = LEAF(BREAK, SYMBOL_NONE, @$); }
| HASH_WHILE condition body HASH_END
    { $$ = LISTS(WHILE, NONE, SYMBOL_NONE, @$, ONE($condition), $body, EMPTY); }
| HASH_FOR '(' NAME comma bounds ')' body HASH_END
    { $$ = LISTS(FOR, NONE, SYMBOL_NONE, @$, ONE(LEAF(NAME, $NAME, @NAME)), $bounds, $body); }
| HASH_FOR error RESYNC body HASH_END
    { $$ = LISTS(FOR, NONE, SYMBOL_NONE, @$, EMPTY, EMPTY, $body); yyerrok; }
| HASH_MACRO NAME '(' names comma ')' body HASH_END
    { $$ = LISTS(MACRO, NONE, $NAME, @$, $names, $body, EMPTY); }
| HASH_MACRO NAME '(' ')' body HASH_END
    { $$ = LISTS(MACRO, NONE, $NAME, @$, EMPTY, $body, EMPTY); }
| HASH_MACRO error RESYNC body HASH_END
    { $$ = LISTS(MACRO, NONE, SYMBOL_NONE, @$, EMPTY, $body, EMPTY); yyerrok; }
;

// Those that hold no items of the text around them.
simple:
  declare                           { $$ = $declare; }
| message                           { $$ = $message; }
| file                              { $$ = $file; }
| include                           { $$ = $include; }
| HASH_UNDEF target                 { $$ = NODE(UNDEF, NONE, SYMBOL_NONE, @$, $target, NULL, NULL); }
| HASH_DEFAULT '{' block_body '}'   { $$ = LIST(DEFAULT, SYMBOL_NONE, @$, $block_body); }
| HASH_VERSION sum                  %prec JUXTAPOSED
    { $$ = grammar_end_version(state, NODE(VERSION, NONE, SYMBOL_NONE, @$, $sum, NULL, NULL)); }
| HASH_VERSION sum ';'              { $$ = NODE(VERSION, NONE, SYMBOL_NONE, @$, $sum, NULL, NULL); }
;

include: HASH_INCLUDE sum           %prec JUXTAPOSED { $$ = NODE(INCLUDE, NONE, SYMBOL_NONE, @$, $sum, NULL, NULL); };

declare:
  assignment                        %prec JUXTAPOSED { $$ = grammar_end_declare(state, $assignment); }
| assignment ';'                    %prec JUXTAPOSED { $$ = ast_flag($assignment, AST_ENDED); }
| assignment ';' ';'                { $$ = ast_flag($assignment, AST_ENDED | AST_ENDED_TWICE); }
;

assignment:
  HASH_DECLARE deprecation target '=' value
    { $$ = NODE(DECLARE, DECLARE, SYMBOL_NONE, @$, $target, $value, NULL); }
| HASH_LOCAL deprecation target '=' value
    { $$ = NODE(DECLARE, LOCAL, SYMBOL_NONE, @$, $target, $value, NULL); }
| HASH_DECLARE deprecation target '=' unreadable
    { $$ = ast_flag(NODE(DECLARE, DECLARE, SYMBOL_NONE, @$, $target, $unreadable, NULL), AST_UNREADABLE); }
| HASH_LOCAL deprecation target '=' unreadable
    { $$ = ast_flag(NODE(DECLARE, LOCAL, SYMBOL_NONE, @$, $target, $unreadable, NULL), AST_UNREADABLE); }
;

// The name is declared all the same, so that its uses are not reported as well.
unreadable: error RESYNC            { $$ = ast_number(&state->builder, 0, @$); yyerrok; };

// `deprecated "why"` warns those who use the name; rtlang does not.
deprecation:
  %empty
| DEPRECATED STRING
| DEPRECATED WORD STRING
;

target:
  NAME                              %prec JUXTAPOSED { $$ = LEAF(NAME, $NAME, @$); }
| indexed                           %prec JUXTAPOSED { $$ = $indexed; }
;

conditional:
  HASH_IF condition body else_part HASH_END
    { $$ = LISTS(IF, NONE, SYMBOL_NONE, @$, ONE($condition), $body, $else_part); }
| HASH_IFDEF '(' subject ')' body else_part HASH_END
    { $$ = LISTS(IFDEF, IFDEF, SYMBOL_NONE, @$, ONE($subject), $body, $else_part); }
| HASH_IFNDEF '(' subject ')' body else_part HASH_END
    { $$ = LISTS(IFDEF, IFNDEF, SYMBOL_NONE, @$, ONE($subject), $body, $else_part); }
| HASH_IFDEF error RESYNC body else_part HASH_END
    { $$ = LISTS(IFDEF, IFDEF, SYMBOL_NONE, @$, EMPTY, $body, $else_part); yyerrok; }
| HASH_IFNDEF error RESYNC body else_part HASH_END
    { $$ = LISTS(IFDEF, IFNDEF, SYMBOL_NONE, @$, EMPTY, $body, $else_part); yyerrok; }
| HASH_SWITCH condition body cases HASH_END
    { $$ = LISTS(SWITCH, NONE, SYMBOL_NONE, @$, ONE($condition), $cases, $body); }
;

// A reserved word, a number or a string may be asked for, too: it is not defined.
subject:
  target                            { $$ = $target; }
| NUMBER                            { $$ = ast_number(&state->builder, $NUMBER, @$); }
| STRING                            { $$ = LEAF(STRING, $STRING, @$); }
| reserved                          { $$ = LEAF(NAME, $reserved, @$); }
;

condition:
  '(' full ')'                      { $$ = $full; }
| error RESYNC                      { $$ = ast_number(&state->builder, 0, @$); yyerrok; }
;

else_part:
  %empty                            { $$ = EMPTY; }
| HASH_ELSE body                    { $$ = $body; }
| HASH_ELSEIF condition body else_part[rest]
    { $$ = ONE(LISTS(IF, NONE, SYMBOL_NONE, @$, ONE($condition), $body, $rest)); }
;

// An #else may stand between cases, but not before them.
cases:
  case                              { $$ = ONE($case); }
| cases case                        { $$ = ast_append($1, $case); }
| cases otherwise                   { $$ = ast_append($1, $otherwise); }
;

case:
  HASH_CASE condition body          { $$ = LISTS(CASE, NONE, SYMBOL_NONE, @$, ONE($condition), $body, EMPTY); }
| HASH_RANGE '(' sum[low] comma sum[high] ')' body
    { $$ = LISTS(RANGE, NONE, SYMBOL_NONE, @$, ONE($low), ONE($high), $body); }
| HASH_RANGE error RESYNC body      { $$ = LISTS(CASE, NONE, SYMBOL_NONE, @$, EMPTY, $body, EMPTY); yyerrok; }
;

otherwise: HASH_ELSE body           { $$ = LIST(ELSE, SYMBOL_NONE, @$, $body); };

bounds:
  sum[from] comma sum[to]           %prec JUXTAPOSED { $$ = ast_append(ONE($from), $to); }
| sum[from] comma sum[to] ','       { $$ = ast_append(ONE($from), $to); }
| sum[from] comma sum[to] comma sum[step]
    %prec JUXTAPOSED { $$ = ast_append(ast_append(ONE($from), $to), $step); }
;

names:
  NAME                              { $$ = ONE(LEAF(NAME, $NAME, @$)); }
| names NAME                        { $$ = ast_append($1, LEAF(NAME, $NAME, @NAME)); }
| names ',' NAME                    { $$ = ast_append($1, LEAF(NAME, $NAME, @NAME)); }
;

message:
  HASH_DEBUG sum                    %prec JUXTAPOSED { $$ = NODE(MESSAGE, DEBUG, SYMBOL_NONE, @$, $sum, NULL, NULL); }
| HASH_WARNING sum                  %prec JUXTAPOSED { $$ = NODE(MESSAGE, WARNING, SYMBOL_NONE, @$, $sum, NULL, NULL); }
| HASH_ERROR sum                    %prec JUXTAPOSED { $$ = NODE(MESSAGE, ERROR, SYMBOL_NONE, @$, $sum, NULL, NULL); }
| HASH_RENDER sum                   %prec JUXTAPOSED { $$ = NODE(MESSAGE, RENDER, SYMBOL_NONE, @$, $sum, NULL, NULL); }
| HASH_STATISTICS sum               %prec JUXTAPOSED
    { $$ = NODE(MESSAGE, STATISTICS, SYMBOL_NONE, @$, $sum, NULL, NULL); }
;

file:
  HASH_FOPEN NAME sum mode          { $$ = NODE(FOPEN, NONE, $mode, @$, LEAF(NAME, $NAME, @NAME), $sum, NULL); }
| HASH_FCLOSE NAME                  { $$ = NODE(FCLOSE, NONE, SYMBOL_NONE, @$, LEAF(NAME, $NAME, @NAME), NULL, NULL); }
| HASH_READ '(' NAME ',' written comma ')'
    { $$ = LISTS(READ, NONE, SYMBOL_NONE, @$, ONE(LEAF(NAME, $NAME, @NAME)), $written, EMPTY); }
| HASH_WRITE '(' NAME comma written comma ')'
    { $$ = LISTS(WRITE, NONE, SYMBOL_NONE, @$, ONE(LEAF(NAME, $NAME, @NAME)), $written, EMPTY); }
;

mode: WORD | DIRECTIVE_WORD;

// Values, or the places that take them, and words for the form of a number (uint8, …) before them.
written:
  value                             { $$ = ONE($value); }
| WORD                              { $$ = ONE(LEAF(WORD, $WORD, @$)); }
| written value                     { $$ = ast_append($1, $value); }
| written ',' value                 { $$ = ast_append($1, $value); }
| written WORD                      { $$ = ast_append($1, LEAF(WORD, $WORD, @WORD)); }
| written ',' WORD                  { $$ = ast_append($1, LEAF(WORD, $WORD, @WORD)); }
;

// ---- Expressions. Relations and choices stand in parentheses only, so that `<1, 2>` is always a vector.

full:
  logic                             %prec JUXTAPOSED { $$ = $logic; }
| logic '?' full[then] ':' full[else]
    { $$ = FOLD(NODE(CONDITIONAL, CONDITIONAL, SYMBOL_NONE, @$, $logic, $then, $else)); }
;

logic:
  relation                          %prec JUXTAPOSED { $$ = $relation; }
| logic '&' relation                %prec JUXTAPOSED { $$ = FOLD(BINARY(AND, @$, $1, $relation)); }
| logic '|' relation                %prec JUXTAPOSED { $$ = FOLD(BINARY(OR, @$, $1, $relation)); }
;

relation:
  sum                               %prec JUXTAPOSED { $$ = $sum; }
| relation '=' sum                  %prec JUXTAPOSED { $$ = FOLD(BINARY(EQ, @$, $1, $sum)); }
| relation NOT_EQUAL sum            %prec JUXTAPOSED { $$ = FOLD(BINARY(NE, @$, $1, $sum)); }
| relation '<' sum                  %prec JUXTAPOSED { $$ = FOLD(BINARY(LT, @$, $1, $sum)); }
| relation LESS_EQUAL sum           %prec JUXTAPOSED { $$ = FOLD(BINARY(LE, @$, $1, $sum)); }
| relation '>' sum                  %prec JUXTAPOSED { $$ = FOLD(BINARY(GT, @$, $1, $sum)); }
| relation GREATER_EQUAL sum        %prec JUXTAPOSED { $$ = FOLD(BINARY(GE, @$, $1, $sum)); }
;

// One rule, by precedences: a number is one reduction away from here.
sum:
  NUMBER                            { $$ = ast_number(&state->builder, $NUMBER, @$); }
| VECTOR                            { $$ = $VECTOR; }
| STRING                            { $$ = LEAF(STRING, $STRING, @$); }
| NAME                              %prec JUXTAPOSED { $$ = grammar_name(state, $NAME, @$); }
| CONSTANT                          { $$ = LEAF(CONSTANT, $CONSTANT, @$); }
| indexed                           %prec JUXTAPOSED { $$ = FOLD($indexed); }
| '<' components '>'                { $$ = FOLD(LIST(VECTOR, SYMBOL_NONE, @$, $components)); }
| '<' components ',' '>'
    { $$ = FOLD(LIST(VECTOR, SYMBOL_NONE, @$, ast_flag_last($components, AST_BEFORE_COMMA))); }
| '(' full ')'                      { $$ = ast_flag($full, AST_IN_PARENTHESES); }
| '(' inline ')'                    { $$ = ast_flag($inline, AST_IN_PARENTHESES); }
| NAME '(' arguments ')'            { $$ = CALL(LIST(CALL, $NAME, @$, $arguments)); }
| NAME '(' arguments ',' ')'        { $$ = CALL(LIST(CALL, $NAME, @$, ast_flag_last($arguments, AST_BEFORE_COMMA))); }
| NAME '(' arguments ',' WORD ')'
    { $$ = CALL(LIST(CALL, $NAME, @$, ast_append_after_comma($arguments, LEAF(WORD, $WORD, @WORD)))); }
| NAME '(' ')'                      { $$ = CALL(LIST(CALL, $NAME, @$, EMPTY)); }
| indexed '(' arguments ')'         { $$ = FOLD(LISTS(CALL, NONE, SYMBOL_NONE, @$, $arguments, ONE($indexed), EMPTY)); }
| indexed '(' arguments ',' WORD ')'
    { $$ = FOLD(LISTS(CALL, NONE, SYMBOL_NONE, @$,
                      ast_append_after_comma($arguments, LEAF(WORD, $WORD, @WORD)), ONE($indexed), EMPTY)); }
| BUILTIN '(' operands ')'          { $$ = FOLD(LIST(BUILTIN, $BUILTIN, @$, $operands)); }
| BUILTIN '(' ')'                   { $$ = FOLD(LIST(BUILTIN, $BUILTIN, @$, EMPTY)); }
| sum '.' member                    { $$ = FOLD(NODE(MEMBER, NONE, $member, @$, $1, NULL, NULL)); }
| '-' sum[operand]                  %prec UNARY { $$ = FOLD(NODE(UNARY, NEG, SYMBOL_NONE, @$, $operand, NULL, NULL)); }
| '+' sum[operand]                  %prec UNARY { $$ = FOLD(NODE(UNARY, PLUS, SYMBOL_NONE, @$, $operand, NULL, NULL)); }
| '!' sum[operand]                  %prec UNARY { $$ = FOLD(NODE(UNARY, NOT, SYMBOL_NONE, @$, $operand, NULL, NULL)); }
| sum '*' sum                       { $$ = FOLD(BINARY(MUL, @$, $1, $3)); }
| sum '/' sum                       { $$ = FOLD(BINARY(DIV, @$, $1, $3)); }
| sum '+' sum                       { $$ = FOLD(BINARY(ADD, @$, $1, $3)); }
| sum '-' sum                       { $$ = FOLD(BINARY(SUB, @$, $1, $3)); }
;

// A directive in the place of a value: what its chosen branch or its file holds.
inline:
  conditional                       { $$ = NODE(INLINE, NONE, SYMBOL_NONE, @$, $conditional, NULL, NULL); }
| include                           { $$ = NODE(INLINE, NONE, SYMBOL_NONE, @$, $include, NULL, NULL); }
;

// The parentheses of a function of one number are parentheses: `abs(a < b)`.
operands:
  full                              %prec JUXTAPOSED { $$ = ONE($full); }
| operands sum                      %prec JUXTAPOSED { $$ = ast_append($1, ast_flag($sum, AST_WITHOUT_COMMA)); }
| operands ',' sum                  %prec JUXTAPOSED { $$ = ast_append($1, $sum); }
;

indexed:
  NAME '[' sum ']'                  
    { $$ = grammar_element(state, NODE(INDEX, NONE, SYMBOL_NONE, @$, LEAF(NAME, $NAME, @NAME), $sum, NULL)); }
| indexed '[' sum ']'
    { $$ = grammar_element(state, NODE(INDEX, NONE, SYMBOL_NONE, @$, $1, $sum, NULL)); }
;

components:
  sum                               %prec JUXTAPOSED { $$ = ONE($sum); }
| inline                            { $$ = ONE($inline); }
| components sum                    %prec JUXTAPOSED { $$ = ast_append($1, $sum); }
| components ',' sum                %prec JUXTAPOSED { $$ = ast_append($1, $sum); }
| components inline                 { $$ = ast_append($1, $inline); }
| components ',' inline             { $$ = ast_append($1, $inline); }
;

member: NAME | reserved;

reserved:
  CONSTANT | BUILTIN | WORD | COLOUR | TEXTURE | ARRAY | FUNCTION | TERM | DIRECTIVE_WORD | DEPRECATED;
%%

static void grammar_yyerror(Span *at, GrammarState *state, const char *message)
{
    (void)message; // bison's only other message is that its stack is full
    diag_report(state->builder.diags, DIAG_E0601, *at, "expressions and blocks nest too deeply here");
    state->faulty = true;
}

static int yyreport_syntax_error(const yypcontext_t *fault, GrammarState *state)
{
    grammar_scan_apart(state);
    yysymbol_kind_t kinds[YYNTOKENS];
    const char *expected[YYNTOKENS];
    int count = yypcontext_expected_tokens(fault, kinds, YYNTOKENS);
    for (int i = 0; i < count; i++) {
        expected[i] = yysymbol_name(kinds[i]);
    }
    grammar_report_syntax(state, expected, count > 0 ? (size_t)count : 0);
    return 0;
}
