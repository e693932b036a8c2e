// Landlock by its system calls, seccomp by a program for the kernel's filter: no library is needed for either.
//
// Turns lists of folders into rules. Nothing here fails: a folder that is not there needs no rule, and what reads or
// writes there reports it. Knows nothing of scenes.
//
// SPDX-License-Identifier: MIT
#ifndef _GNU_SOURCE
#define _GNU_SOURCE
#endif
#include "cli/confine.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "base/attributes.h"
#include "base/confine_filter.h"

// Of <linux/landlock.h>, whose newer parts older systems lack. The numbers are the kernel's and never change.
enum { LANDLOCK_VERSION = 1, RULE_PATH_BENEATH = 1 };
enum {
    FS_EXECUTE = 1 << 0,
    FS_WRITE_FILE = 1 << 1,
    FS_READ_FILE = 1 << 2,
    FS_READ_DIR = 1 << 3,
    FS_REMOVE_FILE = 1 << 5,
    FS_MAKE_REG = 1 << 8,
    FS_FIRST = (1 << 13) - 1, // all of version 1
    FS_REFER = 1 << 13,       // version 2
    FS_TRUNCATE = 1 << 14,    // version 3
    FS_IOCTL_DEV = 1 << 15,   // version 5
    NET_TCP = 3,              // bind and connect, version 4
    SCOPES = 3,               // abstract sockets and signals, version 6
    FS_OF_FILES = FS_EXECUTE | FS_WRITE_FILE | FS_READ_FILE | FS_TRUNCATE | FS_IOCTL_DEV,
};

typedef struct RulesetAttributes {
    uint64_t files, network, scopes;
} RulesetAttributes;

typedef struct __attribute__((packed)) PathRule {
    uint64_t allowed;
    int32_t folder;
} PathRule;

#ifndef __NR_landlock_create_ruleset
enum { __NR_landlock_create_ruleset = 444, __NR_landlock_add_rule = 445, __NR_landlock_restrict_self = 446 };
#endif

// Sanitizers look at a program from processes of their own, valgrind knows none of this, and what counts the lines that
// a test reaches writes files beside the objects.
static const char *stands_back(void)
{
    const char *preloaded = getenv("LD_PRELOAD");
#if defined RTLANG_COVERAGE
    return "none: built with --coverage";
#elif defined __SANITIZE_ADDRESS__ || defined __SANITIZE_THREAD__
    return "none: built with a sanitizer";
#elif defined __has_feature
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
    return "none: built with a sanitizer";
#endif
#endif
    return preloaded && strstr(preloaded, "/vgpreload_") ? "none: runs in valgrind" : NULL;
}

static long landlock_version(void)
{
    return syscall(__NR_landlock_create_ruleset, NULL, 0, LANDLOCK_VERSION);
}

void confine_describe(char text[CONFINE_TEXT])
{
    const char *why_not = stands_back();
    long version = why_not ? 0 : landlock_version();
    bool has_filter = !why_not && confine_filter_exists();
    char landlock[32] = "no Landlock";
    if (version > 0) {
        snprintf(landlock, sizeof landlock, "Landlock %ld", version);
    }
    snprintf(text, CONFINE_TEXT, "%s%s", why_not ? why_not : landlock,
             why_not ? "" : has_filter ? ", seccomp" : ", no seccomp");
}

// ---- Landlock

typedef struct Ruleset {
    int fd;
    uint64_t handled;
} Ruleset;

static void allow(const Ruleset *ruleset, const char *path, uint64_t rights)
{
    struct stat status;
    int fd = path ? open(path, O_PATH | O_CLOEXEC) : -1;
    if (fd < 0) {
        return;
    }
    bool is_folder = fstat(fd, &status) == 0 && S_ISDIR(status.st_mode);
    PathRule rule = {rights & ruleset->handled & (is_folder ? UINT64_MAX : FS_OF_FILES), fd};
    if (rule.allowed != 0) {
        (void)syscall(__NR_landlock_add_rule, ruleset->fd, RULE_PATH_BENEATH, &rule, 0);
    }
    close(fd);
}

static void allow_folder_of(const Ruleset *ruleset, const char *path, uint64_t rights)
{
    char folder[PATH_MAX];
    const char *slash = strrchr(path, '/');
    size_t length = slash == path ? 1 : slash ? (size_t)(slash - path) : 0;
    if (length < sizeof folder) {
        snprintf(folder, sizeof folder, "%.*s", slash ? (int)length : 1, slash ? path : ".");
        allow(ruleset, folder, rights);
    }
}

// A file is made beside the one that it replaces, where that one is; what is no file is written in place, and so is
// what a link to nothing names.
static void allow_output(const Ruleset *ruleset, const char *path)
{
    enum { REPLACE = FS_READ_DIR | FS_WRITE_FILE | FS_MAKE_REG | FS_REMOVE_FILE | FS_REFER | FS_TRUNCATE };
    char real[PATH_MAX];
    struct stat status;
    if (stat(path, &status) == 0 && !S_ISREG(status.st_mode)) {
        allow(ruleset, path, S_ISDIR(status.st_mode) ? 0 : FS_WRITE_FILE | FS_TRUNCATE | FS_IOCTL_DEV);
        return;
    }
    allow_folder_of(ruleset, realpath(path, real) ? real : path, REPLACE);
    ssize_t length = readlink(path, real, sizeof real - 1);
    if (length > 0) {
        real[length] = '\0';
        allow_folder_of(ruleset, real, REPLACE);
    }
}

// The files that tell each scene's session where POV-Ray's include files are (base/library.c).
static void allow_povray_ini(const Ruleset *ruleset)
{
    static const char *const at_home[] = {".povray", ".povrayrc"};
    const char *home = getenv("HOME");
    char path[PATH_MAX];
    allow(ruleset, getenv("POVINI"), FS_READ_FILE);
    allow(ruleset, "/etc/povray", FS_READ_FILE | FS_READ_DIR);
    allow(ruleset, "/etc/povray.ini", FS_READ_FILE);
    for (size_t i = 0; home && i < RT_COUNT_OF(at_home); i++) {
        snprintf(path, sizeof path, "%s/%s", home, at_home[i]);
        allow(ruleset, path, FS_READ_FILE | FS_READ_DIR);
    }
}

// What every run reads: what the C library and the loader ask the system, and where modules and their libraries are.
static void allow_system(const Ruleset *ruleset, bool is_strict)
{
    static const char *const always[] = {"/proc/self", "/sys/devices/system/cpu", "/dev/null", "/dev/urandom"};
    static const char *const libraries[] = {"/usr", "/lib", "/lib64", "/etc/ld.so.cache", "/proc/cpuinfo",
                                            "/proc/meminfo"};
    char self[PATH_MAX];
    for (size_t i = 0; i < RT_COUNT_OF(always); i++) {
        allow(ruleset, always[i], FS_READ_FILE | FS_READ_DIR);
    }
    if (is_strict) {
        return;
    }
    for (size_t i = 0; i < RT_COUNT_OF(libraries); i++) {
        allow(ruleset, libraries[i], FS_READ_FILE | FS_READ_DIR);
    }
    allow_povray_ini(ruleset);
    for (const char *folder = getenv("LD_LIBRARY_PATH"); folder && *folder;) {
        int length = (int)strcspn(folder, ":");
        snprintf(self, sizeof self, "%.*s", length, folder);
        allow(ruleset, self, FS_READ_FILE | FS_READ_DIR);
        folder += length + (folder[length] == ':');
    }
    // In the folder where it was built, modules are beside the program; installed, in ../lib.
    ssize_t length = readlink("/proc/self/exe", self, sizeof self - sizeof "/../lib");
    char *slash = length > 0 ? memrchr(self, '/', (size_t)length) : NULL;
    if (slash) {
        *slash = '\0';
        allow(ruleset, self, FS_READ_FILE | FS_READ_DIR);
        memcpy(slash, "/../lib", sizeof "/../lib");
        allow(ruleset, self, FS_READ_FILE | FS_READ_DIR);
    }
}

// Standard output: "-", or "-.ENDING".
static bool is_stream(const char *path)
{
    return path[0] == '-' && (path[1] == '\0' || (path[1] == '.' && !strchr(path, '/')));
}

static void confine_files(const Confinement *confinement)
{
    long version = landlock_version();
    RulesetAttributes attributes = {.files = FS_FIRST, .network = NET_TCP, .scopes = SCOPES};
    if (version < 1) {
        return;
    }
    attributes.files |= (version >= 2 ? FS_REFER : 0) | (version >= 3 ? FS_TRUNCATE : 0) |
                        (version >= 5 ? FS_IOCTL_DEV : 0);
    size_t size = version >= 6 ? sizeof attributes : version >= 4 ? 2 * sizeof(uint64_t) : sizeof(uint64_t);
    Ruleset ruleset = {(int)syscall(__NR_landlock_create_ruleset, &attributes, size, 0), attributes.files};
    if (ruleset.fd < 0) {
        return;
    }
    allow_system(&ruleset, confinement->is_strict);
    for (size_t i = 0; i < confinement->read_count; i++) {
        allow(&ruleset, confinement->reads[i], FS_READ_FILE | FS_READ_DIR);
    }
    for (size_t i = 0; i < confinement->write_count; i++) {
        if (confinement->writes[i] && !is_stream(confinement->writes[i])) {
            allow_output(&ruleset, confinement->writes[i]);
        }
    }
    for (size_t i = 0; i < confinement->folder_count; i++) {
        allow(&ruleset, confinement->folders[i],
              FS_READ_FILE | FS_READ_DIR | FS_WRITE_FILE | FS_MAKE_REG | FS_TRUNCATE);
    }
    (void)syscall(__NR_landlock_restrict_self, ruleset.fd, 0);
    close(ruleset.fd);
}

void confine(const Confinement *confinement)
{
    // Without it the kernel allows neither to anybody but root; with it a program that is run gains no rights.
    if (stands_back() || prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) {
        return;
    }
    confine_files(confinement);
    confine_filter((confinement->is_strict ? CONFINE_IS_STRICT : 0) | (confinement->serves ? CONFINE_SERVES : 0));
}
