// Reads the limits of memory that the system reports. Owns nothing.
//
// SPDX-License-Identifier: MIT
#include "base/machine.h"

#include <inttypes.h>
#include <limits.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

static size_t least(size_t a, uint64_t b)
{
    return b < a ? (size_t)b : a;
}

static uint64_t less_a_share(uint64_t bytes)
{
    return bytes - bytes / 8;
}

static size_t limit_by_resource(int resource, size_t memory)
{
    struct rlimit limit;
    bool is_limited = getrlimit((__rlimit_resource_t)resource, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY;
    return is_limited ? least(memory, less_a_share(limit.rlim_cur)) : memory;
}

// The number in a file of a control group; a group without a limit has "max" or a number larger than any machine.
static size_t limit_by_file(const char *path, size_t memory)
{
    uint64_t bytes;
    FILE *file = fopen(path, "re");
    if (!file) {
        return memory;
    }
    bool is_limited = fscanf(file, "%" SCNu64, &bytes) == 1;
    fclose(file);
    return is_limited ? least(memory, less_a_share(bytes)) : memory;
}

// A group's limit and those of the groups that it is in.
static size_t limit_by_groups(const char *top, char *group, const char *name, size_t memory)
{
    char path[PATH_MAX];
    for (char *end = group + strlen(group); end; end = strrchr(group, '/')) {
        *end = '\0';
        if (snprintf(path, sizeof path, "%s%s/%s", top, group, name) < (int)sizeof path) {
            memory = limit_by_file(path, memory);
        }
    }
    return memory;
}

// Each line is NUMBER:CONTROLLERS:GROUP; version 2 has no controllers.
static size_t limit_by_container(size_t memory)
{
    char line[PATH_MAX];
    FILE *file = fopen("/proc/self/cgroup", "re");
    while (file && fgets(line, sizeof line, file)) {
        char *controllers = strchr(line, ':'), *group = controllers ? strchr(controllers + 1, ':') : NULL;
        if (!group) {
            continue;
        }
        *group++ = '\0';
        group[strcspn(group, "\n")] = '\0';
        if (controllers[1] == '\0') {
            memory = limit_by_groups("/sys/fs/cgroup", group, "memory.max", memory);
        } else if (strcmp(controllers + 1, "memory") == 0) {
            memory = limit_by_groups("/sys/fs/cgroup/memory", group, "memory.limit_in_bytes", memory);
        }
    }
    if (file) {
        fclose(file);
    }
    return memory;
}

size_t machine_memory(void)
{
    long pages = sysconf(_SC_PHYS_PAGES), page_bytes = sysconf(_SC_PAGESIZE);
    size_t memory = pages > 0 && page_bytes > 0 ? (size_t)pages * (size_t)page_bytes : SIZE_MAX;
    memory = limit_by_resource(RLIMIT_AS, memory);
    memory = limit_by_resource(RLIMIT_DATA, memory);
    return limit_by_container(memory);
}
