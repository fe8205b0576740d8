/* Stands between a process and the C library: counts what is done to files below a folder, and at
 * the n-th operation kills the process, cuts the power, or has the operation fail.
 *
 * Loaded by LD_PRELOAD, so it sees what Python does and what its extensions in C and C++ do.
 * Nothing is counted until faults_arm is called. Not seen: close, stat, and what the C library
 * does by itself (FILE of stdio, dlopen).
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

enum { OBSERVE, KILL, POWER, TORN, SHORT, FULL, BROKEN, DENIED };
enum { FILES = 512, LOG = 1 << 20 };

static char root[4096];
static long at = -1, count;
static int how, full;
static char text[LOG];
static size_t used;

/* Files that were written to, with how many bytes are on the disk for sure. */
static struct { dev_t dev; ino_t ino; int own; off_t synced; } files[FILES];
static int opened;

static int real_open(const char *path, int flags) {
    return (int)syscall(SYS_openat, AT_FDCWD, path, flags | O_CLOEXEC, 0);
}

static long file_of(int fd) {
    struct stat now;
    if (fstat(fd, &now)) return -1;
    for (int k = 0; k < opened; k++)
        if (files[k].dev == now.st_dev && files[k].ino == now.st_ino) return k;
    return -1;
}

static void remember(int fd, int flags) {
    char link[64];
    struct stat now;
    if (fstat(fd, &now) || !S_ISREG(now.st_mode)) return;
    long k = file_of(fd);
    if (k < 0 && opened < FILES) {
        k = opened++;
        files[k].dev = now.st_dev;
        files[k].ino = now.st_ino;
        files[k].synced = now.st_size;
        snprintf(link, sizeof link, "/proc/self/fd/%d", fd);
        files[k].own = real_open(link, O_RDWR); /* a description of its own: it shares no lock */
    }
    if (k >= 0 && flags & O_TRUNC) files[k].synced = 0;
}

static void synced(int fd) {
    struct stat now;
    long k = file_of(fd);
    if (k >= 0 && !fstat(fd, &now)) files[k].synced = now.st_size;
}

static void end(int power) {
    struct stat now;
    for (int k = 0; power && k < opened; k++)
        if (files[k].own >= 0 && !fstat(files[k].own, &now) && now.st_size > files[k].synced)
            syscall(SYS_ftruncate, files[k].own, files[k].synced);
    _exit(137);
}

static int below(const char *path) { return root[0] && !strncmp(path, root, strlen(root)); }

static void place(char *out, size_t size, int folder, const char *path) {
    char link[64], base[4096] = "";
    if (path[0] != '/') {
        if (folder == AT_FDCWD) {
            if (!getcwd(base, sizeof base)) base[0] = 0;
        } else {
            snprintf(link, sizeof link, "/proc/self/fd/%d", folder);
            ssize_t n = readlink(link, base, sizeof base - 1);
            base[n < 0 ? 0 : n] = 0;
        }
    }
    snprintf(out, size, "%s%s%s", base, base[0] ? "/" : "", path);
}

static int watched(int fd, char *out, size_t size) {
    char link[64];
    if (!root[0]) return 0;
    snprintf(link, sizeof link, "/proc/self/fd/%d", fd);
    ssize_t n = readlink(link, out, size - 1);
    if (n < 0) return 0;
    out[n] = 0;
    return below(out);
}

/* Take one operation: 0 to go on, else the error that it fails with; TORN and SHORT are -1. */
static int taken(const char *what, const char *path, const char *to) {
    long now = count++;
    if (used < LOG - 9000)
        used += (size_t)snprintf(text + used, LOG - used, "%s\t%s\t%s\n", what, path, to);
    int grows = !strcmp(what, "write") || !strcmp(what, "create") || !strcmp(what, "mkdir");
    if (full && grows) return ENOSPC;
    if (now != at) return 0;
    switch (how) {
    case KILL: end(0); break;
    case POWER: end(1); break;
    case TORN: case SHORT: return -1;
    case FULL: full = 1; return ENOSPC;
    case BROKEN: return EIO;
    case DENIED: return EACCES;
    }
    return 0;
}

#define REAL(name) \
    static __typeof__(name) *real; \
    if (!real) real = (__typeof__(name) *)dlsym(RTLD_NEXT, #name)
#define FAIL(value) do { if (error > 0) { errno = error; return value; } } while (0)

void faults_arm(const char *folder, long place_, int how_) {
    snprintf(root, sizeof root, "%s", folder);
    at = place_;
    how = how_;
    count = 0;
    full = opened = 0;
    used = 0;
    text[0] = 0;
}

long faults_count(void) { return count; }
const char *faults_log(void) { return text; }

#define OPEN(name, parameters, call, folder) \
    int name parameters { \
        REAL(name); \
        mode_t mode = 0; \
        if (flags & (O_CREAT | __O_TMPFILE)) { \
            va_list rest; \
            va_start(rest, flags); \
            mode = va_arg(rest, mode_t); \
            va_end(rest); \
        } \
        char whole[8192]; \
        place(whole, sizeof whole, folder, path); \
        int writes = (flags & O_ACCMODE) != O_RDONLY; \
        if (below(whole)) { \
            int error = taken(flags & O_CREAT ? "create" : writes ? "open" : "look", whole, ""); \
            FAIL(-1); \
        } \
        int fd = call; \
        if (fd >= 0 && writes && below(whole)) remember(fd, flags); \
        return fd; \
    }
OPEN(open, (const char *path, int flags, ...), real(path, flags, mode), AT_FDCWD)
OPEN(open64, (const char *path, int flags, ...), real(path, flags, mode), AT_FDCWD)
OPEN(openat, (int at_, const char *path, int flags, ...), real(at_, path, flags, mode), at_)
OPEN(openat64, (int at_, const char *path, int flags, ...), real(at_, path, flags, mode), at_)

/* A write: all, half of it and then death, or half of it and then a full disk. */
#define WRITE(name, parameters, whole_call, half_call, length) \
    ssize_t name parameters { \
        REAL(name); \
        char path[8192]; \
        if (!watched(fd, path, sizeof path)) return whole_call; \
        int error = taken("write", path, ""); \
        FAIL(-1); \
        if (error < 0 && how == TORN) { half_call; end(0); } \
        if (error < 0) { full = 1; if ((length) > 1) return half_call; errno = ENOSPC; return -1; } \
        return whole_call; \
    }
WRITE(write, (int fd, const void *data, size_t size),
      real(fd, data, size), real(fd, data, size / 2), size)
WRITE(pwrite, (int fd, const void *data, size_t size, off_t from),
      real(fd, data, size, from), real(fd, data, size / 2, from), size)
WRITE(pwrite64, (int fd, const void *data, size_t size, off64_t from),
      real(fd, data, size, from), real(fd, data, size / 2, from), size)
WRITE(writev, (int fd, const struct iovec *parts, int n),
      real(fd, parts, n), real(fd, parts, 1), n)

#define ON_FILE(name, type, parameters, call, what, after) \
    type name parameters { \
        REAL(name); \
        char path[8192]; \
        if (watched(fd, path, sizeof path)) { \
            int error = taken(what, path, ""); \
            FAIL(-1); \
        } \
        type done = call; \
        if (done == 0) { after; } \
        return done; \
    }
ON_FILE(fsync, int, (int fd), real(fd), "sync", synced(fd))
ON_FILE(fdatasync, int, (int fd), real(fd), "sync", synced(fd))
ON_FILE(ftruncate, int, (int fd, off_t size), real(fd, size), "truncate", )
ON_FILE(ftruncate64, int, (int fd, off64_t size), real(fd, size), "truncate", )
ON_FILE(fchmod, int, (int fd, mode_t mode), real(fd, mode), "chmod", )
ON_FILE(futimens, int, (int fd, const struct timespec t[2]), real(fd, t), "utime", )
ON_FILE(read, ssize_t, (int fd, void *data, size_t size), real(fd, data, size), "read", )
ON_FILE(pread64, ssize_t, (int fd, void *data, size_t size, off64_t from),
        real(fd, data, size, from), "read", )

#define ON_PATH(name, parameters, call, folder, path, what) \
    int name parameters { \
        REAL(name); \
        char whole[8192]; \
        place(whole, sizeof whole, folder, path); \
        if (below(whole)) { \
            int error = taken(what, whole, ""); \
            FAIL(-1); \
        } \
        return call; \
    }
ON_PATH(unlink, (const char *p), real(p), AT_FDCWD, p, "unlink")
ON_PATH(unlinkat, (int d, const char *p, int f), real(d, p, f), d, p, "unlink")
ON_PATH(rmdir, (const char *p), real(p), AT_FDCWD, p, "rmdir")
ON_PATH(mkdir, (const char *p, mode_t m), real(p, m), AT_FDCWD, p, "mkdir")
ON_PATH(mkdirat, (int d, const char *p, mode_t m), real(d, p, m), d, p, "mkdir")
ON_PATH(chmod, (const char *p, mode_t m), real(p, m), AT_FDCWD, p, "chmod")
ON_PATH(fchmodat, (int d, const char *p, mode_t m, int f), real(d, p, m, f), d, p, "chmod")
ON_PATH(truncate, (const char *p, off_t n), real(p, n), AT_FDCWD, p, "truncate")
ON_PATH(truncate64, (const char *p, off64_t n), real(p, n), AT_FDCWD, p, "truncate")
ON_PATH(symlink, (const char *to, const char *p), real(to, p), AT_FDCWD, p, "link")
ON_PATH(link, (const char *from, const char *p), real(from, p), AT_FDCWD, p, "link")

int utimensat(int d, const char *p, const struct timespec t[2], int f) {
    REAL(utimensat);
    char whole[8192];
    place(whole, sizeof whole, d, p);
    if (below(whole)) {
        int error = taken("utime", whole, "");
        FAIL(-1);
    }
    return real(d, p, t, f);
}

#define RENAME(name, parameters, call, d1, a, d2, b) \
    int name parameters { \
        REAL(name); \
        char from[8192], to[8192]; \
        place(from, sizeof from, d1, a); \
        place(to, sizeof to, d2, b); \
        if (below(from) || below(to)) { \
            int error = taken("rename", from, to); \
            FAIL(-1); \
        } \
        return call; \
    }
RENAME(rename, (const char *a, const char *b), real(a, b), AT_FDCWD, a, AT_FDCWD, b)
RENAME(renameat, (int d1, const char *a, int d2, const char *b), real(d1, a, d2, b), d1, a, d2, b)
RENAME(renameat2, (int d1, const char *a, int d2, const char *b, unsigned f),
       real(d1, a, d2, b, f), d1, a, d2, b)
