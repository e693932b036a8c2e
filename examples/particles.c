/* A thousand particles from arrays, drawn from two sides: `cc particles.c $(pkg-config --cflags --libs rtlang) -lm`.
 *
 * The arrays are read where they are; no text is made. The second picture costs its frame alone.
 *
 * SPDX-License-Identifier: MIT
 */
#include <math.h>
#include <rtlang/rtlang.h>
#include <stdio.h>

enum { PARTICLES = 1000 };

typedef struct Particle {
    float place[3], radius;
    float color[3];
} Particle;

static void tell(void *client, const rt_diagnostic *diagnostic)
{
    (void)client;
    fputs(diagnostic->text, stderr);
}

/* A helix that grows, from blue to yellow. */
static void fill(Particle *particles)
{
    for (int i = 0; i < PARTICLES; i++) {
        float share = (float)i / PARTICLES, turn = 60.0f * share;
        float wide = 1.0f + 3.0f * share;
        particles[i] = (Particle){{wide * cosf(turn), 8.0f * share - 4.0f, wide * sinf(turn)},
                                  0.1f + 0.3f * share,
                                  {share, share, 1.0f - share}};
    }
}

int main(void)
{
    static Particle particles[PARTICLES];
    const ptrdiff_t stride = sizeof *particles, step = sizeof(float);
    fill(particles);
    rt_callbacks callbacks = {.diagnostic = tell};
    rt_session *session = rt_session_new(&callbacks);
    rt_spheres spheres = {
        .count = PARTICLES,
        .centers = {particles->place, RT_FLOAT32, stride, step},
        .radii = {&particles->radius, RT_FLOAT32, stride, 0},
        .look = {{particles->color, RT_FLOAT32, stride, step}, 3, "phong 0.4 ambient 0.2"},
    };
    rt_camera camera = {.location = {0, 3, -14}, .look_at = {0, 0, 0}, .angle = 45};
    rt_light light = {.position = {-10, 12, -10}, .color = {1, 1, 1}};
    rt_output output = {.depth = RT_DEPTH_AUTO};
    int status = !session || rt_set_size(session, 320, 240) || rt_begin_scene(session) ||
                 rt_add_spheres(session, &spheres, NULL) || rt_add_light(session, &light) ||
                 rt_set_camera(session, &camera) || rt_render(session, 0) || rt_write(session, "front.png", &output);
    camera.location[0] = 9;
    camera.location[2] = 11;
    status = status || rt_set_camera(session, &camera) || rt_render(session, 0) ||
             rt_write(session, "back.png", &output);
    rt_session_free(session);
    return status;
}
