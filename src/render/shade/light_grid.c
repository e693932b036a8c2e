// SPDX-License-Identifier: MIT
#include "render/shade/light_grid.h"

#include <math.h>
#include <stdlib.h>

// ---- all lights

// What a light of a row counts, of 1 for the row: as often as it is an end of the parts into which the row is halved
// until no light is between their ends.
static double row_weight(int size, int at)
{
    double weight = 1.0;
    int low = 0;
    for (int span = size - 1; span > 0; span /= 2) {
        int above = 2 * (at - low) - span;
        weight *= above == 0 ? 1.0 : 0.5; // in the middle: an end of both halves
        low += above >= 0 ? span - span / 2 : 0;
    }
    return weight;
}

static void next_of_all(LightGrid *grid)
{
    const LightArea *area = grid->area;
    for (int k = 0; k < grid->asked_count; k++) { // of 1 or 0 exact, in whichever order
        grid->sum = rgb_add_scaled(grid->sum, grid->asked[k].weight, grid->asked[k].share);
    }
    grid->asked_count = 0;
    double of_row = row_weight(area->size2, grid->next_j);
    while (grid->asked_count < LIGHT_ASKED_MAX && grid->next_j < area->size2) {
        double weight = of_row * row_weight(area->size1, grid->next_i);
        grid->asked[grid->asked_count++] = (LightAsked){.i = grid->next_i++, .j = grid->next_j, .weight = weight};
        if (grid->next_i == area->size1) {
            grid->next_i = 0;
            of_row = row_weight(area->size2, ++grid->next_j);
        }
    }
}

// ---- adaptive

// True when what two lights send of `arriving` is so far apart that an adaptive area light is divided. Found by
// pictures: parts that differ in all three colours divide it between 0.032 and 0.034, in two between 0.045 and 0.05.
static bool differs(Rgb arriving, Rgb a, Rgb b)
{
    Rgb apart = rgb_mul(arriving, rgb_add_scaled(a, -1.0, b));
    return fabs(apart.red) + fabs(apart.green) + fabs(apart.blue) > 0.1;
}

static bool is_divided(const LightArea *area, const LightPart *part, Rgb arriving)
{
    if (part->right - part->left <= 1 && part->bottom - part->top <= 1) {
        return false;
    }
    bool is_even = part->level >= area->adaptive;
    for (int side = 0; is_even && side < 4; side++) { // not across: light may change slowly from corner to corner
        is_even = !differs(arriving, part->corners[side & 1 ? 3 : 0], part->corners[side & 2 ? 2 : 1]);
    }
    return !is_even;
}

static LightEnds quarter_ends(int first, int last)
{
    LightEnds ends = {{first, (first + last) / 2, (first + last + 1) / 2, last}, {0, 1, 2, 3}};
    for (int k = 1; k < 4; k++) {
        int at = ends.at[k];
        ends.same[k] = at == first ? 0 : at == last ? 3 : k == 2 && at == ends.at[1] ? 1 : k;
    }
    return ends;
}

static bool is_end(int place)
{
    return place == 0 || place == 3;
}

// Where the answer of a light on an edge of the divided part is kept for the parts beyond it; it stands there when `at`
// does. NULL for lights at the part's corners and within it, which no other part wants.
static LightAnswer *kept_answer(const LightGrid *grid, const LightAsked *light, int *at)
{
    if (is_end(light->row) == is_end(light->column) || !grid->lower) {
        return NULL;
    }
    *at = is_end(light->row) ? light->j : light->i;
    return is_end(light->row) ? &grid->lower[light->i] : &grid->right[light->j];
}

// Asks for the lights at the ends of the quarters of the divided part that are not known, or, of the whole grid before
// it is divided, for its corners.
static void ask_for_part(LightGrid *grid)
{
    const LightPart *part = &grid->divided;
    LightEnds columns = grid->columns = quarter_ends(part->left, part->right);
    LightEnds rows = grid->rows = quarter_ends(part->top, part->bottom);
    for (int place = 0; place < 16; place++) {
        int row = place / 4, column = place % 4, at;
        bool is_corner = is_end(row) && is_end(column);
        if (rows.same[row] != row || columns.same[column] != column || (grid->is_whole && !is_corner)) {
            continue;
        }
        LightAsked light = {.i = columns.at[column], .j = rows.at[row], .row = row, .column = column};
        const LightAnswer *kept = kept_answer(grid, &light, &at);
        if (is_corner && !grid->is_whole) {
            grid->shares[row][column] = part->corners[(row ? 2 : 0) + (column ? 1 : 0)];
        } else if (kept && kept->at == at) {
            grid->shares[row][column] = kept->share;
        } else {
            grid->asked[grid->asked_count++] = light;
        }
    }
}

static void take_answers(LightGrid *grid)
{
    for (int k = 0; k < grid->asked_count; k++) {
        const LightAsked *light = &grid->asked[k];
        int at;
        LightAnswer *kept = kept_answer(grid, light, &at);
        grid->shares[light->row][light->column] = light->share;
        if (kept) {
            *kept = (LightAnswer){at, light->share};
        }
    }
    grid->asked_count = 0;
}

// Puts a part, between two of its ends each way, on the list. Its corners are known.
static void wait_for(LightGrid *grid, const LightPart *whole, int row, int column, int step, double weight)
{
    const LightEnds *columns = &grid->columns, *rows = &grid->rows;
    LightPart *part = &grid->parts[grid->count++]; // all of it is set here
    part->left = columns->at[column];
    part->right = columns->at[column + step];
    part->top = rows->at[row];
    part->bottom = rows->at[row + step];
    part->level = whole->level + (step == 1);
    part->weight = weight;
    for (int corner = 0; corner < 4; corner++) {
        part->corners[corner] =
            grid->shares[rows->same[row + (corner & 2 ? step : 0)]][columns->same[column + (corner & 1 ? step : 0)]];
    }
}

// The quarters of a part, of which those of one row or column are but two.
static void wait_for_quarters(LightGrid *grid, const LightPart *whole)
{
    bool is_column = whole->left == whole->right, is_row = whole->top == whole->bottom;
    double weight = whole->weight * (is_column || is_row ? 0.5 : 0.25);
    for (int quarter = 3; quarter >= 0; quarter--) {
        if (!(is_column && (quarter & 1)) && !(is_row && (quarter & 2))) {
            wait_for(grid, whole, quarter & 2, quarter & 1 ? 2 : 0, 1, weight);
        }
    }
}

// Puts what the answers were wanted for on the list: the whole grid, or a part's quarters.
static void wait_for_divided(LightGrid *grid)
{
    if (grid->is_whole) {
        wait_for(grid, &grid->divided, 0, 0, 3, 1.0);
    } else {
        wait_for_quarters(grid, &grid->divided);
    }
    grid->is_whole = false;
}

static void add_primitive(LightGrid *grid, const LightPart *part)
{
    Rgb sum = rgb_grey(0.0);
    for (int corner = 0; corner < 4; corner++) {
        sum = rgb_add(sum, part->corners[corner]);
    }
    grid->sum = rgb_add_scaled(grid->sum, 0.25 * part->weight, sum);
}

static void next_of_adaptive(LightGrid *grid, Rgb arriving)
{
    take_answers(grid);
    wait_for_divided(grid);
    while (grid->count > 0 && grid->asked_count == 0) {
        const LightPart *part = &grid->parts[--grid->count];
        if (!is_divided(grid->area, part, arriving)) {
            add_primitive(grid, part);
            continue;
        }
        grid->divided = *part;
        ask_for_part(grid);
        if (grid->asked_count == 0) {
            wait_for_divided(grid);
        }
    }
}

// ---- either

static void keep_answers(LightGrid *grid)
{
    int count = grid->area->size1 + grid->area->size2;
    bool fits = count <= LIGHT_ANSWERS_OWN;
    grid->allocated = fits ? NULL : malloc((size_t)count * sizeof *grid->allocated);
    grid->lower = fits ? grid->own : grid->allocated;
    for (int i = 0; grid->lower && i < count; i++) {
        grid->lower[i].at = -1;
    }
    grid->right = grid->lower ? grid->lower + grid->area->size1 : NULL;
}

void light_grid_begin(LightGrid *grid, const LightArea *area)
{
    grid->area = area;
    grid->sum = rgb_grey(0.0);
    grid->asked_count = grid->count = grid->next_i = grid->next_j = 0;
    grid->allocated = NULL;
    if (area->is_adaptive) {
        keep_answers(grid);
        grid->divided = (LightPart){.right = area->size1 - 1, .bottom = area->size2 - 1, .weight = 1.0};
        grid->is_whole = true;
        ask_for_part(grid);
    } else {
        next_of_all(grid);
    }
}

void light_grid_next(LightGrid *grid, Rgb arriving)
{
    if (grid->area->is_adaptive) {
        next_of_adaptive(grid, arriving);
    } else {
        next_of_all(grid);
    }
    if (grid->asked_count == 0) {
        light_grid_end(grid);
    }
}

void light_grid_end(LightGrid *grid)
{
    grid->asked_count = 0;
    free(grid->allocated);
    grid->allocated = NULL;
}
