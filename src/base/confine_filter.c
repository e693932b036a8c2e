// A program for the kernel's packet filter, written step by step: the architecture, the calls that are refused, and
// those that are refused for some of their arguments.
//
// Refused is what a ray tracer has no use for and an intruder has: the list names calls, so that a C library of
// tomorrow that uses new ones for threads or memory still runs.
//
// SPDX-License-Identifier: MIT
#ifndef _GNU_SOURCE
#define _GNU_SOURCE
#endif
#include "base/confine_filter.h"

#include <errno.h>
#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sched.h>
#include <signal.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "base/attributes.h"
#include "base/process.h"

#if defined __x86_64__ && !defined __ILP32__
#define ARCHITECTURE AUDIT_ARCH_X86_64
#elif defined __aarch64__
#define ARCHITECTURE AUDIT_ARCH_AARCH64
#endif

#ifdef ARCHITECTURE
static const uint16_t refused[] = {
    // programs and processes
    __NR_execve, __NR_execveat, __NR_ptrace, __NR_process_vm_readv, __NR_process_vm_writev, __NR_kill, __NR_tkill,
    __NR_rt_sigqueueinfo, __NR_rt_tgsigqueueinfo, __NR_setns, __NR_unshare,
#ifdef __NR_fork
    __NR_fork, __NR_vfork,
#endif
#ifdef __NR_pidfd_getfd
    __NR_pidfd_open, __NR_pidfd_getfd, __NR_pidfd_send_signal,
#endif
    // sockets
    __NR_socket, __NR_socketpair, __NR_connect, __NR_bind, __NR_listen,
    // the system and other users
    __NR_mount, __NR_umount2, __NR_pivot_root, __NR_chroot, __NR_reboot, __NR_swapon, __NR_swapoff, __NR_init_module,
    __NR_finit_module, __NR_delete_module, __NR_kexec_load, __NR_acct, __NR_syslog, __NR_sethostname,
    __NR_setdomainname, __NR_settimeofday, __NR_clock_settime, __NR_adjtimex, __NR_quotactl, __NR_personality,
    __NR_setuid, __NR_setgid, __NR_setreuid, __NR_setregid, __NR_setresuid, __NR_setresgid, __NR_setgroups,
    __NR_setfsuid, __NR_setfsgid, __NR_capset,
    // parts of the kernel that were ways in more than once
    __NR_bpf, __NR_perf_event_open, __NR_userfaultfd, __NR_add_key, __NR_request_key, __NR_keyctl,
    __NR_name_to_handle_at, __NR_open_by_handle_at, __NR_memfd_create,
#ifdef __NR_io_uring_setup
    __NR_io_uring_setup, __NR_io_uring_enter, __NR_io_uring_register,
#endif
    // files: links, devices, owners
    __NR_symlinkat, __NR_mknodat, __NR_fchownat, __NR_fchown,
#ifdef __NR_symlink
    __NR_symlink, __NR_mknod, __NR_chown, __NR_lchown,
#endif
};

// What is done with sockets that are there: refused but to a run that serves.
static const uint16_t refused_connections[] = {
    __NR_accept, __NR_accept4, __NR_sendto, __NR_sendmsg, __NR_sendmmsg, __NR_recvfrom, __NR_recvmsg, __NR_recvmmsg,
};

// What changes files: refused to a process that only reads.
static const uint16_t refused_writes[] = {
    __NR_ftruncate, __NR_truncate, __NR_renameat,  __NR_renameat2, __NR_unlinkat,  __NR_linkat,    __NR_mkdirat,
    __NR_fchmod,    __NR_fchmodat, __NR_utimensat, __NR_setxattr,  __NR_fsetxattr, __NR_lsetxattr, __NR_fallocate,
#ifdef __NR_openat2
    __NR_openat2,
#endif
#ifdef __NR_creat
    __NR_creat,     __NR_rename,   __NR_unlink,    __NR_rmdir,     __NR_link,      __NR_mkdir,     __NR_chmod,
#endif
};

enum {
    REFUSED = RT_COUNT_OF(refused),
    REFUSED_CONNECTIONS = RT_COUNT_OF(refused_connections),
    REFUSED_WRITES = RT_COUNT_OF(refused_writes),
    STEPS_MOST = 2 * (REFUSED + REFUSED_CONNECTIONS + REFUSED_WRITES) + 64,
    X32_CALLS = 0x40000000
};

typedef struct Filter {
    struct sock_filter steps[STEPS_MOST];
    unsigned short count;
} Filter;

static void put(Filter *filter, uint16_t code, uint32_t value, uint8_t if_true, uint8_t if_false)
{
    filter->steps[filter->count++] = (struct sock_filter){code, if_true, if_false, value};
}

static void put_load(Filter *filter, size_t offset)
{
    put(filter, BPF_LD | BPF_W | BPF_ABS, (uint32_t)offset, 0, 0);
}

static void put_end(Filter *filter, uint32_t verdict)
{
    put(filter, BPF_RET | BPF_K, verdict, 0, 0);
}

// The lower half of an argument; both processors are little-endian.
static size_t argument(unsigned i)
{
    return offsetof(struct seccomp_data, args) + i * sizeof(uint64_t);
}

enum { REFUSE = SECCOMP_RET_ERRNO | EPERM };

// Refuses a call where the bits of an argument have (or, by `is_without`, lack) the given ones.
static void put_bits(Filter *filter, uint32_t call, unsigned i, uint32_t bits, bool is_without)
{
    put(filter, BPF_JMP | BPF_JEQ | BPF_K, call, 0, 4);
    put_load(filter, argument(i));
    put(filter, BPF_JMP | BPF_JSET | BPF_K, bits, is_without ? 1 : 0, is_without ? 0 : 1);
    put_end(filter, REFUSE);
    put_end(filter, SECCOMP_RET_ALLOW);
}

// Refuses a call with one value of an argument, or (`is_other`) with any other.
static void put_value(Filter *filter, uint32_t call, unsigned i, uint32_t value, bool is_other)
{
    put(filter, BPF_JMP | BPF_JEQ | BPF_K, call, 0, 4);
    put_load(filter, argument(i));
    put(filter, BPF_JMP | BPF_JEQ | BPF_K, value, is_other ? 1 : 0, is_other ? 0 : 1);
    put_end(filter, REFUSE);
    put_end(filter, SECCOMP_RET_ALLOW);
}

static void put_refused(Filter *filter, const uint16_t *calls, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        put(filter, BPF_JMP | BPF_JEQ | BPF_K, calls[i], 0, 1);
        put_end(filter, REFUSE);
    }
}

// Of the calls of clone, those for threads; and for copies of this process, unless it only reads.
static void put_clone(Filter *filter, bool has_copies)
{
    put(filter, BPF_JMP | BPF_JEQ | BPF_K, __NR_clone, 0, has_copies ? 9 : 4); // past all that is put here
    if (has_copies) {
        put_load(filter, argument(0) + sizeof(uint32_t));
        put(filter, BPF_JMP | BPF_JEQ | BPF_K, process_key(), 0, 3);
        put_load(filter, argument(0));
        put(filter, BPF_JMP | BPF_JEQ | BPF_K, SIGCHLD, 0, 1);
        put_end(filter, SECCOMP_RET_ALLOW);
    }
    put_load(filter, argument(0));
    put(filter, BPF_JMP | BPF_JSET | BPF_K, CLONE_THREAD, 1, 0);
    put_end(filter, REFUSE);
    put_end(filter, SECCOMP_RET_ALLOW);
}

static void put_open(Filter *filter, uint32_t call, unsigned flags)
{
    put_bits(filter, call, flags, O_WRONLY | O_RDWR | O_CREAT | O_TRUNC, false);
}

static void make(Filter *filter, unsigned what)
{
    put_load(filter, offsetof(struct seccomp_data, arch));
    put(filter, BPF_JMP | BPF_JEQ | BPF_K, ARCHITECTURE, 1, 0);
    put_end(filter, SECCOMP_RET_KILL_PROCESS);
    put_load(filter, offsetof(struct seccomp_data, nr));
    put(filter, BPF_JMP | BPF_JGE | BPF_K, X32_CALLS, 0, 1);
    put_end(filter, REFUSE);
    put_refused(filter, refused, REFUSED);
    put_refused(filter, refused_connections, what & CONFINE_SERVES ? 0 : REFUSED_CONNECTIONS);
    // The C library starts threads by clone where there is no clone3, whose flags a filter cannot see.
    put(filter, BPF_JMP | BPF_JEQ | BPF_K, __NR_clone3, 0, 1);
    put_end(filter, SECCOMP_RET_ERRNO | ENOSYS);
    put_clone(filter, !(what & CONFINE_READS));
    put_value(filter, __NR_tgkill, 0, (uint32_t)getpid(), true); // abort signals itself
    put_value(filter, __NR_ioctl, 1, TIOCSTI, false);            // puts words into a terminal
    if (what & CONFINE_READS) {
        put_refused(filter, refused_writes, REFUSED_WRITES);
        put_open(filter, __NR_openat, 2);
#ifdef __NR_open
        put_open(filter, __NR_open, 1);
#endif
    }
    if (what & CONFINE_IS_STRICT) {
        put_bits(filter, __NR_mmap, 2, PROT_EXEC, false);
        put_bits(filter, __NR_mprotect, 2, PROT_EXEC, false);
    }
    put_end(filter, SECCOMP_RET_ALLOW);
}

bool confine_filter_exists(void)
{
    uint32_t action = SECCOMP_RET_ERRNO;
    return syscall(__NR_seccomp, SECCOMP_GET_ACTION_AVAIL, 0, &action) == 0;
}

// SPEC_ALLOW: the program keeps no secrets from its scene, and the kernel would slow its loads down for them.
void confine_filter(unsigned what)
{
    Filter filter = {.count = 0};
    const unsigned all = what & CONFINE_READS ? SECCOMP_FILTER_FLAG_TSYNC : 0;
    make(&filter, what);
    struct sock_fprog program = {filter.count, filter.steps};
    (void)syscall(__NR_seccomp, SECCOMP_SET_MODE_FILTER, SECCOMP_FILTER_FLAG_SPEC_ALLOW | all, &program);
}
#else
bool confine_filter_exists(void)
{
    return false;
}

void confine_filter(unsigned what)
{
    (void)what;
}
#endif
