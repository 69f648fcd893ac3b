/*
 * output.c - output files that are there whole or not at all.
 *
 * open: FOLDER/.aset-XXXXXX  --write-->  close: rename to FOLDER/NAME      failure, signal: unlink
 *
 * A scene, model, draft or picture that is read, or a file that another output becomes, is no place for an output: it would be lost. What has
 * been read is remembered by device and number, where an output goes by its folder's and the name in it.
 *
 * Invariant: places[i].used is set exactly while the file named in places[i].temporary is ours and not yet renamed or
 * removed. The handler of signals reads only that table. Between a rename and the clearing of used it may unlink a
 * name that is gone, which does nothing.
 */
#include "tool.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Outputs open at once: a command writes a picture, its statistics and a few tables. */
#define PLACES 8
/* Longest path of an output, its end included; a limit of ours, since not every system has one. */
#define PATH_BYTES 4096
/* Links of links followed before it is called a circle, as kernels do. */
#define LINKS_MAX 40

#define TEMPORARY_NAME ".aset-XXXXXX"

static struct place {
    volatile sig_atomic_t used;
    char temporary[PATH_BYTES];
    char target[PATH_BYTES];
    struct stat folder; /* of the target */
    struct stat old;    /* what the target is so far; st_ino 0: nothing */
} places[PLACES];

/* The files that were opened for reading, for as long as the program runs. */
static struct stat *inputs;
static size_t n_inputs, inputs_room;

static const int deadly_signals[] = {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGALRM, SIGVTALRM, SIGXCPU, SIGUSR1, SIGUSR2};
#define N_DEADLY (sizeof deadly_signals / sizeof deadly_signals[0])

/*
 * Only calls that are safe in a handler. The action is reset on entry, so the raised signal ends the program as it
 * should.
 */
static void remove_temporaries(int signal_number) {
    for (unsigned i = 0; i < PLACES; i++) {
        if (places[i].used) {
            (void)unlink(places[i].temporary);
        }
    }
    (void)raise(signal_number);
}

static void ignore_signal(int signal_number) {
    struct sigaction action;
    memset(&action, 0, sizeof action);
    action.sa_handler = SIG_IGN;
    (void)sigemptyset(&action.sa_mask);
    (void)sigaction(signal_number, &action, NULL);
}

/* A signal that the program was started to ignore (nohup, a job in the background) stays ignored. */
static void catch_signal(int signal_number) {
    struct sigaction action;
    if (sigaction(signal_number, NULL, &action) == 0 && action.sa_handler == SIG_IGN) {
        return;
    }
    memset(&action, 0, sizeof action);
    action.sa_handler = remove_temporaries;
    action.sa_flags = (int)SA_RESETHAND;
    (void)sigemptyset(&action.sa_mask);
    (void)sigaction(signal_number, &action, NULL);
}

/*
 * A standard stream that was closed by the caller leaves its number to the next file opened, which would then receive
 * the program's output. /dev/null, opened the wrong way round, takes the number: using the stream stays an error.
 */
static void fill_standard_numbers(void) {
    for (int number = STDIN_FILENO; number <= STDERR_FILENO; number++) {
        if (fcntl(number, F_GETFD) == -1 && errno == EBADF) {
            (void)open("/dev/null", number == STDIN_FILENO ? O_WRONLY : O_RDONLY);
        }
    }
}

void tool_output_guard(void) {
    fill_standard_numbers();
    for (size_t i = 0; i < N_DEADLY; i++) {
        catch_signal(deadly_signals[i]);
    }
    ignore_signal(SIGPIPE);
#ifdef SIGXFSZ
    ignore_signal(SIGXFSZ);
#endif
}

const char *tool_output_name(const char *path) {
    return strcmp(path, "-") == 0 ? "standard output" : path;
}

/* Puts name in the place of path's last component: true, or false if there is no room. */
static bool replace_last(char path[PATH_BYTES], const char *name) {
    char *slash = strrchr(path, '/');
    char *last = slash == NULL || name[0] == '/' ? path : slash + 1;
    size_t length = strlen(name);
    if ((size_t)(last - path) + length >= PATH_BYTES) {
        return false;
    }
    memcpy(last, name, length + 1);
    return true;
}

/*
 * Follows path's symbolic links to the file, there already or not, that writing to path would write: so that the
 * rename replaces that file and not the link. False with errno.
 */
static bool find_target(char target[PATH_BYTES], const char *path) {
    char link_text[PATH_BYTES];
    struct stat status;
    size_t length = strlen(path);
    if (length >= PATH_BYTES) {
        errno = ENAMETOOLONG;
        return false;
    }
    memcpy(target, path, length + 1);
    for (unsigned links = 0; links < LINKS_MAX; links++) {
        if (lstat(target, &status) != 0) {
            return errno == ENOENT;
        }
        if (!S_ISLNK(status.st_mode)) {
            return true;
        }
        ssize_t bytes = readlink(target, link_text, sizeof link_text);
        if (bytes < 0) {
            return false;
        }
        link_text[(size_t)bytes < sizeof link_text ? (size_t)bytes : sizeof link_text - 1] = '\0';
        if ((size_t)bytes >= sizeof link_text || !replace_last(target, link_text)) {
            errno = ENAMETOOLONG;
            return false;
        }
    }
    errno = ELOOP;
    return false;
}

/*
 * Makes the temporary beside the target, with signals held off until the table knows it. Its descriptor, or -1 with
 * errno.
 */
static int make_temporary(struct place *place) {
    sigset_t deadly, before;
    size_t length = strlen(place->target);
    memcpy(place->temporary, place->target, length + 1);
    if (!replace_last(place->temporary, TEMPORARY_NAME)) {
        errno = ENAMETOOLONG;
        return -1;
    }
    (void)sigemptyset(&deadly);
    for (size_t i = 0; i < N_DEADLY; i++) {
        (void)sigaddset(&deadly, deadly_signals[i]);
    }
    (void)sigprocmask(SIG_BLOCK, &deadly, &before);
    int descriptor = mkstemp(place->temporary);
    int error = errno;
    place->used = descriptor >= 0;
    (void)sigprocmask(SIG_SETMASK, &before, NULL);
    errno = error;
    return descriptor;
}

static void remove_temporary(struct place *place) {
    (void)unlink(place->temporary);
    place->used = 0;
}

/*
 * mkstemp makes private files; an output has the mode of the file it replaces, or what the umask leaves of rw for
 * all.
 */
static mode_t output_mode(const struct stat *old) {
    if (old != NULL) {
        return old->st_mode & (S_IRWXU | S_IRWXG | S_IRWXO);
    }
    mode_t mask = umask(0);
    (void)umask(mask);
    return (S_IRUSR | S_IWUSR | S_IRGRP | S_IWGRP | S_IROTH | S_IWOTH) & ~mask;
}

static bool same_file(const struct stat *a, const struct stat *b) {
    return a->st_dev == b->st_dev && a->st_ino == b->st_ino;
}

static const char *last_part(const char *path) {
    const char *slash = strrchr(path, '/');
    return slash != NULL ? slash + 1 : path;
}

/* What the target's folder is. False with errno. */
static bool stat_folder(const char *target, struct stat *folder) {
    char path[PATH_BYTES + 1];
    size_t length = (size_t)(last_part(target) - target);
    memcpy(path, target, length);
    memcpy(path + length, ".", 2); /* the longest may end with its slash */
    return stat(path, folder) == 0;
}

/* Is the place's target a file that has been read, or another output's? Says so. */
static bool is_taken(const struct place *place, const char *path) {
    for (size_t i = 0; i < n_inputs; i++) {
        if (place->old.st_ino != 0 && same_file(&place->old, &inputs[i])) {
            tool_error(path, 0, "it is read, too, expected another file for the output");
            return true;
        }
    }
    for (const struct place *other = places; other < places + PLACES; other++) {
        if (other != place && other->used && same_file(&other->folder, &place->folder) &&
            strcmp(last_part(other->target), last_part(place->target)) == 0) {
            tool_error(path, 0, "another output goes there, too, expected another file");
            return true;
        }
    }
    return false;
}

bool tool_input_note(FILE *stream, const char *path) {
    struct stat status;
    if (fstat(fileno(stream), &status) != 0 || !S_ISREG(status.st_mode)) {
        return true;
    }
    for (const struct place *place = places; place < places + PLACES; place++) {
        if (place->used && place->old.st_ino != 0 && same_file(&place->old, &status)) {
            tool_error(path, 0, "the output goes there, too, expected another file for it");
            return false;
        }
    }
    for (size_t i = 0; i < n_inputs; i++) {
        if (same_file(&inputs[i], &status)) {
            return true;
        }
    }
    if (n_inputs == inputs_room) {
        size_t room = 2 * inputs_room + 16;
        struct stat *more = realloc(inputs, room * sizeof *more);
        if (more == NULL) {
            tool_error(path, 0, "the machine has no memory to note that it is read");
            return false;
        }
        inputs = more;
        inputs_room = room;
    }
    inputs[n_inputs++] = status;
    return true;
}

/*
 * Opens the temporary of a free place as output's stream. old is the existing file's status or NULL. False with
 * errno, or with errno 0 after an error line.
 */
static bool open_temporary(tool_output *output, const struct stat *old) {
    int slot = 0;
    while (slot < PLACES && places[slot].used) {
        slot++;
    }
    if (slot == PLACES) {
        errno = EMFILE;
        return false;
    }
    struct place *place = &places[slot];
    /* a rename asks only for rights in the folder, but a file that was made read-only is not to be lost */
    if (!find_target(place->target, output->path) || (old != NULL && access(place->target, W_OK) != 0) ||
        !stat_folder(place->target, &place->folder)) {
        return false;
    }
    memset(&place->old, 0, sizeof place->old);
    if (old != NULL) {
        place->old = *old;
    }
    if (is_taken(place, output->path)) {
        errno = 0;
        return false;
    }
    int descriptor = make_temporary(place);
    if (descriptor < 0) {
        return false;
    }
    output->stream = fchmod(descriptor, output_mode(old)) == 0 ? fdopen(descriptor, "wb") : NULL;
    if (output->stream == NULL) {
        int error = errno;
        (void)close(descriptor);
        remove_temporary(place);
        errno = error;
        return false;
    }
    output->slot = slot;
    return true;
}

bool tool_output_open(tool_output *output, const char *path) {
    struct stat old;
    output->stream = NULL;
    output->path = path;
    output->error = 0;
    output->slot = -1;
    if (strcmp(path, "-") == 0) {
        output->stream = stdout;
        return true;
    }
    if (path[0] == '\0') {
        tool_error(NULL, 0, "the name of an output file is empty");
        return false;
    }
    bool exists = stat(path, &old) == 0;
    bool opened = false;
    if (exists && !S_ISREG(old.st_mode)) {
        output->stream = fopen(path, "wb");
        opened = output->stream != NULL;
    } else if (exists || errno == ENOENT) {
        opened = open_temporary(output, exists ? &old : NULL);
    }
    if (!opened && errno != 0) {
        tool_error(path, 0, "cannot open it for writing: %s", strerror(errno));
    }
    return opened;
}

void tool_print_in_comment(FILE *stream, const char *text) {
    for (; *text != '\0'; text++) {
        unsigned char byte = (unsigned char)*text;
        (void)fputc(byte < 0x20 || byte == 0x7f || byte == '*' || byte == '\\' || byte == '?' ? '_' : byte, stream);
    }
}

void tool_output_fail(tool_output *output, int error) {
    if (output->error == 0) {
        output->error = error != 0 ? error : EIO;
        tool_error(tool_output_name(output->path), 0, "cannot write: %s", strerror(output->error));
    }
}

bool tool_output_write(tool_output *output, const void *bytes, size_t size) {
    if (output->error == 0 && fwrite(bytes, 1, size, output->stream) != size) {
        tool_output_fail(output, errno);
    }
    return output->error == 0;
}

bool tool_output_close(tool_output *output) {
    FILE *stream = output->stream;
    output->stream = NULL;
    if (fflush(stream) != 0) {
        tool_output_fail(output, errno);
    } else if (ferror(stream) != 0) {
        tool_output_fail(output, EIO);
    }
    if (stream != stdout && fclose(stream) != 0) {
        tool_output_fail(output, errno);
    }
    if (output->slot >= 0) {
        struct place *place = &places[output->slot];
        if (output->error == 0 && rename(place->temporary, place->target) != 0) {
            tool_output_fail(output, errno);
        }
        if (output->error != 0) {
            (void)unlink(place->temporary);
        }
        place->used = 0;
        output->slot = -1;
    }
    return output->error == 0;
}

void tool_output_abort(tool_output *output) {
    if (output->stream == NULL) {
        return;
    }
    if (output->stream != stdout) {
        (void)fclose(output->stream);
    }
    output->stream = NULL;
    if (output->slot >= 0) {
        remove_temporary(&places[output->slot]);
        output->slot = -1;
    }
}
