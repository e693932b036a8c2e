// A scene that is printed and read again is printed the same.
//
// SPDX-License-Identifier: MIT
#include <string.h>

#include "fuzz/fuzz.h"
#include "rtlang/rtlang.h"

// What is printed of a scene, to be freed; NULL when it is wrong or too large.
static char *dump(const char *text, size_t size, uint64_t steps, rt_status *status)
{
    const char *printed = NULL;
    char *copy = NULL;
    rt_session *session = rt_session_new(NULL);
    if (session) {
        rt_set_untrusted(session);
        rt_set_limit(session, RT_LIMIT_STEPS, steps);
        rt_set_limit(session, RT_LIMIT_OBJECTS, 1000);
        *status = rt_load_text(session, "fuzz", text, size);
        if (*status == RT_OK && rt_dump_scene(session, &printed) == RT_OK) {
            copy = strdup(printed);
        }
    }
    rt_session_free(session);
    return copy;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    rt_status status = RT_OK;
    char *once = dump((const char *)data, size, 5000, &status);
    char *twice = once ? dump(once, strlen(once), 3000000, &status) : NULL;
    if (once && status != RT_FAULT_LIMIT) {
        FUZZ_HOLDS(twice && strcmp(once, twice) == 0);
    }
    free(once);
    free(twice);
    return 0;
}
