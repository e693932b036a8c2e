// Preloaded into the program: does at its end what an intruder would do, and says what the kernel answered, a line
// each. With INTRUDER_READER it does so in libjpeg's place, as the header of a file is read, and falls over its own
// feet.
//
// INTRUDER_OUT is a folder that the program has no business in. Knows nothing of the program.
//
// SPDX-License-Identifier: MIT
#ifndef _GNU_SOURCE
#define _GNU_SOURCE
#endif
#include <arpa/inet.h>
#include <errno.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/ptrace.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

static void say(const char *what, int is_done)
{
    fprintf(stderr, "%s: %s\n", what, is_done ? "done" : strerrorname_np(errno));
}

static int can_open(const char *folder, const char *name, int flags)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    int fd = open(path, flags, 0600);
    return fd >= 0 && close(fd) == 0;
}

static void intrude(const char *out)
{
    char *arguments[] = {(char *)"true", NULL};
    struct sockaddr_in address = {.sin_family = AF_INET, .sin_port = htons(9), .sin_addr = {htonl(INADDR_LOOPBACK)}};
    say("read", can_open(out, "secret", O_RDONLY));
    say("write", can_open(out, "secret", O_WRONLY));
    say("make", can_open(out, "new", O_WRONLY | O_CREAT));
    char path[4096];
    snprintf(path, sizeof path, "%s/link", out);
    say("symlink", symlink("/", path) == 0);
    int fd = socket(AF_INET, SOCK_STREAM, 0);
    say("socket", fd >= 0);
    say("connect", connect(fd, (struct sockaddr *)&address, sizeof address) == 0);
    say("kill", kill(getppid(), 0) == 0);
    say("ptrace", ptrace(PTRACE_ATTACH, 0x7fffffff, NULL, NULL) == 0);
    say("code", mmap(NULL, 4096, PROT_READ | PROT_EXEC, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0) != MAP_FAILED);
    pid_t child = fork();
    if (child == 0) {
        _exit(0);
    }
    say("fork", child > 0 && waitpid(child, NULL, 0) == child);
    long copy = syscall(SYS_clone, 0x1234567800000000ul | SIGCHLD, 0ul, 0ul, 0ul, 0ul);
    if (copy == 0) {
        _exit(0);
    }
    say("copy", copy > 0);
    unsetenv("INTRUDER_OUT"); // should it run after all
    execv("/bin/true", arguments);
    say("execute", 0);
}

__attribute__((destructor)) static void at_end(void)
{
    const char *out = getenv("INTRUDER_OUT");
    if (out && !getenv("INTRUDER_READER")) {
        intrude(out);
    }
}

__attribute__((visibility("default"))) int jpeg_read_header(void *decoder, int whole)
{
    (void)decoder, (void)whole;
    intrude(getenv("INTRUDER_OUT"));
    __builtin_trap();
}
