// Families, distances, secondary rays and malformed numbers, each formula called as the tracer would call it.
//
// SPDX-License-Identifier: MIT
#include "study/spheres.h"

#include <math.h>

#include "study/cases.h"
#include "study/oracle.h"
#include "trace/sphere.h"

const char *study_formula_name(StudyFormula formula)
{
    return formula == FORMULA_TEXTBOOK ? "textbook" : "rtlang";
}

const char *study_rule_name(SecondaryRule rule)
{
    static const char *const names[RULES] = {"no tolerance", "t > 0.001", "rtlang: id and side"};
    return names[rule];
}

// b² - 4ac, as lectures have it: the nearest root beyond t_min; 0 for a miss.
static double textbook_root(Ray ray, Vec3 centre, double radius, double t_min, SphereClass *class)
{
    Vec3 f = vec3_sub(ray.origin, centre);
    double a = vec3_dot(ray.direction, ray.direction);
    double b = 2.0 * vec3_dot(f, ray.direction);
    double c = vec3_dot(f, f) - radius * radius;
    double h = b * b - 4.0 * a * c;
    *class = CLASS_MISS;
    if (h < 0.0) {
        return 0.0;
    }
    double t1 = (-b - sqrt(h)) / (2.0 * a), t2 = (-b + sqrt(h)) / (2.0 * a);
    *class = t1 > t_min ? CLASS_NEAR : t2 > t_min ? CLASS_FAR : CLASS_MISS;
    // Written so, a t that is no number is a hit: lectures return what is not thrown out.
    if (!(t1 <= t_min)) {
        *class = CLASS_NEAR;
        return t1;
    }
    if (!(t2 <= t_min)) {
        *class = CLASS_FAR;
        return t2;
    }
    return 0.0;
}

static double our_root(Ray ray, Vec3 centre, double radius, SphereClass *class)
{
    SphereRay sphere_ray = sphere_ray_make(ray.origin, ray.direction);
    SphereData ball = sphere_data_make(centre, radius);
    bool inside = false;
    double t = sphere_hit(&sphere_ray, &ball, &inside);
    *class = !(t > 0.0) ? CLASS_MISS : inside ? CLASS_FAR : CLASS_NEAR;
    return t;
}

static double formula_root(StudyFormula formula, Ray ray, Vec3 centre, double radius, SphereClass *class)
{
    return formula == FORMULA_TEXTBOOK ? textbook_root(ray, centre, radius, 0.0, class)
                                       : our_root(ray, centre, radius, class);
}

// ---- families

size_t study_family_count(void)
{
    return RT_COUNT_OF(sphere_families);
}

static void count_case(const SphereCase *input, Oracle *oracle, SphereRow *row)
{
    bool excusable, inside;
    double approximate;
    SphereClass right = oracle_solve(oracle, input, &excusable);
    SphereRay ray = sphere_ray_make(input->ray.origin, input->ray.direction);
    SphereData ball = sphere_data_make(input->centre, input->radius);
    row->doubtful += sphere_test(&ray, &ball, &approximate, &inside) == SPHERE_UNCERTAIN;
    for (int formula = 0; formula < FORMULAS; formula++) {
        SphereClass class;
        double t = formula_root((StudyFormula)formula, input->ray, input->centre, input->radius, &class);
        if (class != CLASS_MISS && !isfinite(t)) {
            row->of[formula].not_finite++;
        }
        if (class != right) {
            row->of[formula].wrong++;
            row->of[formula].inexcusable += !excusable;
        } else if (class != CLASS_MISS && t > 0.0) {
            row->of[formula].ulps = fmax(row->of[formula].ulps, oracle_ulps(oracle, t));
            row->of[formula].backward = fmax(row->of[formula].backward, oracle_backward(oracle, input, t));
        }
    }
    row->cases++;
}

static bool count_family(const SphereFamily *family, uint64_t cases, uint64_t seed, SphereRow *row)
{
    Oracle *oracle = oracle_new();
    Random random = {seed};
    *row = (SphereRow){.family = family->name};
    for (uint64_t i = 0; oracle && i < cases; i++) {
        SphereCase input = sphere_case(family, &random);
        count_case(&input, oracle, row);
    }
    oracle_free(oracle);
    return oracle != NULL;
}

bool study_family(size_t family, uint64_t cases, uint64_t seed, SphereRow *row)
{
    return count_family(&sphere_families[family], cases, seed + family, row);
}

bool study_distances(uint64_t cases, uint64_t seed, DistancePoint points[DISTANCE_POINTS])
{
    bool is_fine = true;
    for (int i = 0; i < DISTANCE_POINTS; i++) {
        SphereFamily family = {"", pow(10.0, 0.5 * (i + 1)), 0.0, 1.0, 1.0, 0.0, 1.0};
        SphereRow row;
        is_fine = is_fine && count_family(&family, cases, seed + (uint64_t)i, &row);
        points[i].distance = family.distance;
        for (int formula = 0; is_fine && formula < FORMULAS; formula++) {
            points[i].backward[formula] = row.of[formula].backward;
            points[i].ulps[formula] = row.of[formula].ulps;
        }
    }
    return is_fine;
}

void study_malformed(uint64_t *cases, uint64_t not_finite[FORMULAS])
{
    const double values[] = {0.0, 1.0, -2.0, (double)NAN, (double)INFINITY, -(double)INFINITY, 1e-320, 1e308};
    const uint64_t count = RT_COUNT_OF(values), all = count * count * count * count;
    *cases = 0;
    not_finite[FORMULA_TEXTBOOK] = not_finite[FORMULA_OURS] = 0;
    for (uint64_t i = 0; i < all; i++, ++*cases) {
        Ray ray = {{values[i % count], 0.5, -3.0}, {0.0, values[i / count % count], values[i / count % count]}};
        Vec3 centre = {0.0, values[i / (count * count) % count], 0.0};
        for (int formula = 0; formula < FORMULAS; formula++) {
            SphereClass class;
            double t = formula_root((StudyFormula)formula, ray, centre, values[i / (count * count * count)], &class);
            not_finite[formula] += class != CLASS_MISS && !isfinite(t);
        }
    }
}

// ---- secondary rays

// A point of a sphere as a tracer has it: a hit's point, rounded, put back onto the surface.
static Vec3 surface_point(const SphereData *ball, Vec3 normal)
{
    return vec3_add_scaled(ball->centre, sqrt(ball->radius_squared), normal);
}

// Whether a ray that leaves outward meets its own sphere.
static bool shades_itself(SecondaryRule rule, Ray ray, const SphereData *ball)
{
    SphereClass class;
    if (rule == RULE_IDENTITY) {
        return false; // it is not asked
    }
    textbook_root(ray, ball->centre, sqrt(ball->radius_squared), rule == RULE_FIXED ? 1e-3 : 0.0, &class);
    return class != CLASS_MISS;
}

// Where a ray that goes in comes out; 0: nowhere.
static double exit_of(SecondaryRule rule, Ray ray, const SphereData *ball)
{
    SphereClass class;
    SphereRay sphere_ray = sphere_ray_make(ray.origin, ray.direction);
    return rule == RULE_IDENTITY
               ? sphere_root_inward(&sphere_ray, ball)
               : textbook_root(ray, ball->centre, sqrt(ball->radius_squared), rule == RULE_FIXED ? 1e-3 : 0.0, &class);
}

static bool meets(SecondaryRule rule, Ray ray, const SphereData *other)
{
    SphereClass class;
    if (rule == RULE_IDENTITY) {
        return our_root(ray, other->centre, sqrt(other->radius_squared), &class) > 0.0;
    }
    textbook_root(ray, other->centre, sqrt(other->radius_squared), rule == RULE_FIXED ? 1e-3 : 0.0, &class);
    return class == CLASS_NEAR;
}

static void count_secondary(double scale, Random *random, SecondaryRow *row)
{
    double away = scale * random_between(random, 0.0, 10.0);
    Vec3 centre = vec3_scale(away, random_direction(random));
    SphereData ball = sphere_data_make(centre, scale * random_between(random, 0.1, 2.0));
    Vec3 normal = random_direction(random), aside = random_perpendicular(random, normal);
    Vec3 point = surface_point(&ball, normal);
    double grazing = pow(10.0, random_between(random, -12.0, -1.0)), cosine = random_between(random, 0.05, 1.0);
    Ray light = {point, vec3_normalize(vec3_add_scaled(aside, grazing, normal))};
    Ray inward = {point, vec3_add_scaled(vec3_scale(sqrt(1.0 - cosine * cosine), aside), -cosine, normal)};
    double radius = sqrt(ball.radius_squared), way = 2.0 * radius * cosine;
    // A neighbour of the same size that nearly touches, met head-on across the gap.
    double gap = radius * pow(10.0, random_between(random, -10.0, -4.0));
    SphereData other = sphere_data_make(vec3_add_scaled(centre, 2.0 * radius + gap, normal), radius);
    Ray across = {point, normal};
    for (int rule = 0; rule < RULES; rule++) {
        double exit = exit_of((SecondaryRule)rule, inward, &ball);
        row->false_shadows[rule] += shades_itself((SecondaryRule)rule, light, &ball);
        row->wrong_exits[rule] += !(fabs(exit - way) <= 1e-6 * way);
        row->missed_contacts[rule] += !meets((SecondaryRule)rule, across, &other);
    }
    row->cases++;
}

void study_secondary(double scale, uint64_t cases, uint64_t seed, SecondaryRow *row)
{
    Random random = {seed};
    *row = (SecondaryRow){.scale = scale};
    for (uint64_t i = 0; i < cases; i++) {
        count_secondary(scale, &random, row);
    }
}

// ---- shells

void study_shells(double gap, uint64_t cases, uint64_t seed, ShellRow *row)
{
    Random random = {seed};
    *row = (ShellRow){.gap = gap, .cases = cases};
    for (uint64_t i = 0; i < cases; i++) {
        Vec3 centre = vec3_scale(0.5, random_direction(&random)), normal = random_direction(&random);
        Vec3 origin = vec3_add_scaled(centre, random_between(&random, 300.0, 1000.0), normal);
        double off_axis = random_between(&random, 0.0, 0.9);
        Vec3 aim = vec3_add_scaled(centre, off_axis, random_perpendicular(&random, normal));
        Ray ray = {origin, vec3_normalize(vec3_sub(aim, origin))};
        Vec3 aside = vec3_add_scaled(centre, 0.25 * gap, random_direction(&random));
        for (int formula = 0; formula < FORMULAS; formula++) {
            SphereClass class;
            double outer = formula_root((StudyFormula)formula, ray, centre, 1.0, &class);
            double inner = formula_root((StudyFormula)formula, ray, aside, 1.0 - gap, &class);
            row->wrong[formula] += inner < outer;
            row->ties[formula] += inner == outer;
        }
    }
}
