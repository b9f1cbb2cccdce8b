/* SPDX-License-Identifier: Apache-2.0
 * Runs a pack's cases (tests/gpu/recorder.h says what it is) on a device and prints a table:
 *
 *   runner FOLDER [--device NAME | NUMBER] [--library FILE] [--seconds N] [--list] [CASE...]
 *
 * Without cases all; they may be patterns, as the shell has them. No case is begun when N seconds
 * (540) have passed. A device is looked for in the system's OpenCL, then in drivers that it may not
 * know of: the first GPU, else the first device. --list names devices and cases.
 * Exit code: 0 all equal, 1 a difference or a failure, 2 usage or no device, 3 some were not run.
 *
 * Compiling needs libc and opencl_driver.h beside it, running libc and an OpenCL driver. */
#define _GNU_SOURCE
#include "opencl_driver.h"

#include <fnmatch.h>
#include <inttypes.h>
#include <time.h>

enum { most_programs = 1024, most_buffers = 4096, most_runs = 1024, most_words = 64 };

struct run {
  unsigned program;
  char kernel[64];
  size_t first, items, group;
  unsigned arguments;
  char argument[most_words][32];
};
static struct {
  char *folder, *data, *cases;
  size_t data_size;
  struct device device;
  struct {
    handle program;
    char text[32], options[256];
  } programs[most_programs];
  handle buffers[most_buffers];
  struct run* runs;
  unsigned run_count;
  double compiling, running, begin, seconds;
} all;

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* What went wrong in a case; the case ends and counts as failed. */
static char trouble[512];
static bool bad(const char* what, long code) {
  snprintf(trouble, sizeof trouble, "%s: %ld", what, code);
  return false;
}

static char* read_file(const char* name, size_t* size) {
  char path[4096];
  snprintf(path, sizeof path, "%s/%s", all.folder, name);
  FILE* file = fopen(path, "rb");
  if (file == NULL || fseek(file, 0, SEEK_END) != 0) die("cannot read %s", path);
  const long end = ftell(file);
  char* bytes = malloc((size_t)end + 1);
  rewind(file);
  if (bytes == NULL || fread(bytes, 1, (size_t)end, file) != (size_t)end)
    die("cannot read %s", path);
  bytes[end] = 0;
  *size = (size_t)end;
  fclose(file);
  return bytes;
}

static const char* data_at(size_t at, size_t size) {
  if (at > all.data_size || size > all.data_size - at)
    die("data.bin ends before %zu + %zu", at, size);
  return all.data + at;
}

/* Where a word names nothing that this program could. */
static size_t number(const char* word, size_t most) {
  char* end = NULL;
  const unsigned long long value = word != NULL ? strtoull(word, &end, 10) : 0;
  if (word == NULL || end == word || *end != 0 || value > most)
    die("cases.txt: %s is no number up to %zu", word ? word : "nothing", most);
  return (size_t)value;
}

/* Compiled when first run with; NULL where it cannot be. */
static handle program(unsigned p) {
  if (all.programs[p].program != NULL) return all.programs[p].program;
  char name[64];
  size_t size = 0, binary = 0;
  snprintf(name, sizeof name, "texts/%s.cl", all.programs[p].text);
  char* text = read_file(name, &size);
  const double begin = now();
  int code = success;
  const char* texts[] = {text};
  handle made = cl.create_program(all.device.context, 1, texts, &size, &code);
  if (code == success)
    code = cl.build_program(made, 1, &all.device.id, all.programs[p].options, NULL, NULL);
  /* PoCL compiles for good when it is asked for the binary. */
  if (code == success) code = cl.program_info(made, binary_sizes, sizeof binary, &binary, NULL);
  all.compiling += now() - begin;
  free(text);
  if (code == success) return all.programs[p].program = made;
  char log[4096] = "";
  if (made != NULL) cl.build_info(made, all.device.id, build_log, sizeof log - 1, log, NULL);
  fprintf(stderr, "%s, built with %s: %d\n%s\n", name, all.programs[p].options, code, log);
  bad("a program did not compile", code);
  return NULL;
}

static bool enqueue(const struct run* r) {
  handle made = program(r->program);
  if (made == NULL) return false;
  int code = success;
  handle kernel = cl.create_kernel(made, r->kernel, &code);
  for (unsigned i = 0; code == success && i < r->arguments; ++i) {
    char word[32], *at = NULL;
    snprintf(word, sizeof word, "%s", r->argument[i]);
    if (word[0] == 'b') {
      code = cl.set_argument(kernel, i, sizeof(handle),
                             &all.buffers[number(word + 1, most_buffers - 1)]);
    } else if ((at = strchr(word, '@')) != NULL) {
      *at = 0;
      const size_t size = number(word + 1, 1024);
      code = cl.set_argument(kernel, i, size, data_at(number(at + 1, SIZE_MAX), size));
    }
  }
  const double begin = now();
  if (code == success)
    code = cl.run(all.device.queue, kernel, 1, &r->first, &r->items, &r->group, 0, NULL, NULL);
  if (code == success) code = cl.finish(all.device.queue);
  all.running += now() - begin;
  if (kernel != NULL) cl.release_kernel(kernel);
  return code == success || bad(r->kernel, code);
}

static uint64_t hash_words(const uint32_t* words, size_t count) {
  uint64_t hash = UINT64_C(0xcbf29ce484222325);
  for (size_t i = 0; i < count; ++i)
    hash = (hash ^ words[i]) * UINT64_C(0x100000001b3);
  return hash;
}

static float as_float(uint32_t word) {
  float value;
  memcpy(&value, &word, sizeof value);
  return value;
}

/* Says how it differs, if it does. */
static bool compare(const uint32_t* got, size_t size, uint64_t hash, const char* at,
                    const char* what) {
  const size_t count = size / 4;
  if (strcmp(at, "-") == 0) {
    const uint64_t own = hash_words(got, count);
    if (own != hash)
      printf("  %s: hash %016" PRIx64 ", expected %016" PRIx64 "\n", what, own, hash);
    return own == hash;
  }
  const char* expected = data_at(number(at, SIZE_MAX), size);
  size_t first = count, different = 0;
  for (size_t i = 0; i < count; ++i) {
    if (memcmp(expected + 4 * i, &got[i], 4) == 0) continue;
    if (different++ == 0) first = i;
  }
  if (different == 0) return true;
  uint32_t word;
  memcpy(&word, expected + 4 * first, 4);
  printf(
      "  %s: first difference at word %zu: %08x (%.9g), expected %08x (%.9g); %zu of %zu words "
      "differ\n",
      what, first, got[first], (double)as_float(got[first]), word, (double)as_float(word),
      different, count);
  return false;
}

static bool write_buffer(size_t b, const char* bytes, size_t size) {
  if (size == 0) return true;
  const int code = cl.write(all.device.queue, all.buffers[b], 1, 0, size, bytes, 0, NULL, NULL);
  return code == success || bad("a buffer could not be written", code);
}

enum outcome { equal, different, failed };

/* One line of a case. */
static enum outcome step(char** words, unsigned count) {
  const char* verb = words[0];
  int code = success;
  if (strcmp(verb, "run") == 0 && count >= 6) {
    if (all.run_count == most_runs) die("cases.txt: too many runs");
    struct run* r = &all.runs[all.run_count++];
    r->program = (unsigned)number(words[1], most_programs - 1);
    snprintf(r->kernel, sizeof r->kernel, "%s", words[2]);
    r->first = number(words[3], SIZE_MAX);
    r->items = number(words[4], SIZE_MAX);
    r->group = number(words[5], SIZE_MAX);
    r->arguments = count - 6;
    for (unsigned i = 0; i < r->arguments; ++i)
      snprintf(r->argument[i], sizeof r->argument[i], "%s", words[6 + i]);
    return enqueue(r) ? equal : failed;
  }
  if (count < 3) die("cases.txt: %s with %u words", verb, count);
  const size_t b = number(words[1], most_buffers - 1), size = number(words[2], SIZE_MAX);
  if (strcmp(verb, "buffer") == 0) {
    all.buffers[b] =
        cl.create_buffer(all.device.context, read_write | (all.device.is_cpu ? alloc_host : 0),
                         size < 16 ? 16 : size, NULL, &code);
    return code == success || bad("a buffer could not be made", code) ? equal : failed;
  }
  if (strcmp(verb, "write") == 0 && count == 4)
    return write_buffer(b, data_at(number(words[3], SIZE_MAX), size), size) ? equal : failed;
  char* bytes = calloc(size + 4, 1);
  if (bytes == NULL) die("no memory for %zu bytes", size);
  enum outcome outcome = failed;
  if (strcmp(verb, "zero") == 0) {
    outcome = write_buffer(b, bytes, size) ? equal : failed;
  } else if (strcmp(verb, "read") == 0 && count == 6) {
    code = cl.read(all.device.queue, all.buffers[b], 1, 0, size, bytes, 0, NULL, NULL);
    if (code != success)
      bad("a buffer could not be read", code);
    else
      outcome =
          compare((const uint32_t*)bytes, size, strtoull(words[3], NULL, 16), words[4], words[5])
              ? equal
              : different;
  } else {
    die("cases.txt: unknown line %s", verb);
  }
  free(bytes);
  return outcome;
}

/* The case's runs of a kernel again, for about a second: the best of them, or 0. */
static double best_seconds(const char* kernel) {
  double best = 0;
  const double begin = now();
  for (int i = 0; i < 50 && (i == 0 || now() - begin < 1) && now() - all.begin < all.seconds; ++i) {
    all.running = 0;
    for (unsigned r = 0; r < all.run_count; ++r)
      if (strcmp(all.runs[r].kernel, kernel) == 0 && !enqueue(&all.runs[r])) return 0;
    if (best == 0 || all.running < best) best = all.running;
  }
  return best;
}

static unsigned split(char* line, char** words, unsigned most) {
  unsigned count = 0;
  for (char* word = strtok(line, " "); word != NULL; word = strtok(NULL, " ")) {
    if (count == most) die("cases.txt: a line of more than %u words", most);
    words[count++] = word;
  }
  return count;
}

static bool is_wanted(const char* name, char** patterns, int count) {
  for (int i = 0; i < count; ++i)
    if (fnmatch(patterns[i], name, 0) == 0) return true;
  return count == 0;
}

static void take_program(char* line) {
  unsigned p = 0;
  char text[32], options[256];
  if (sscanf(line, "program %u %31s %255[^\n]", &p, text, options) != 3 || p >= most_programs)
    die("cases.txt: a program's line is wrong");
  memcpy(all.programs[p].text, text, sizeof text);
  memcpy(all.programs[p].options, options, sizeof options);
}

static int run_cases(char** patterns, int pattern_count, bool list) {
  unsigned counts[3] = {0, 0, 0}, left = 0;
  char name[128] = "", unit[32] = "", kernel[64] = "";
  double units = 0, begin = 0;
  bool active = false;
  enum outcome outcome = equal;
  all.runs = calloc(most_runs, sizeof *all.runs);
  if (!list) printf("%-26s %-8s %9s %10s\n", "case", "result", "compile s", "all s");
  char *rest = all.cases, *line = strsep(&rest, "\n");
  if (line == NULL || strcmp(line, "dsbuild-gpu 1") != 0 || all.runs == NULL)
    die("cases.txt is of another version");
  while ((line = strsep(&rest, "\n")) != NULL) {
    char* words[most_words];
    if (strncmp(line, "program ", 8) == 0) {
      take_program(line);
      continue;
    }
    const unsigned count = split(line, words, most_words);
    if (count == 0) continue;
    if (strcmp(words[0], "case") == 0 && count == 2) {
      snprintf(name, sizeof name, "%s", words[1]);
      active = is_wanted(name, patterns, pattern_count);
      if (list && active) printf("%s\n", name);
      if (active && !list && now() - all.begin > all.seconds) {
        printf("%-26s not run: %.0f seconds have passed\n", name, all.seconds);
        ++left;
      }
      active = active && !list && now() - all.begin <= all.seconds;
      outcome = equal;
      units = all.compiling = 0;
      all.run_count = 0;
      begin = now();
    } else if (!active) {
      continue;
    } else if (strcmp(words[0], "time") == 0 && count == 4) {
      units = strtod(words[1], NULL);
      snprintf(unit, sizeof unit, "%s", words[2]);
      snprintf(kernel, sizeof kernel, "%s", words[3]);
    } else if (strcmp(words[0], "end") == 0) {
      char speed[64] = "";
      const double best = units > 0 && outcome != failed ? best_seconds(kernel) : 0;
      if (best > 0) snprintf(speed, sizeof speed, "%.1f M%s/s", 1e-6 * units / best, unit);
      const char* said[] = {"equal", "differs", "failed"};
      printf("%-26s %-8s %9.2f %10.2f %s\n", name, said[outcome], all.compiling, now() - begin,
             outcome == failed ? trouble : speed);
      fflush(stdout);
      ++counts[outcome];
      for (unsigned i = 0; i < most_buffers; ++i) {
        if (all.buffers[i] != NULL) cl.release_buffer(all.buffers[i]);
        all.buffers[i] = NULL;
      }
    } else if (outcome != failed) {
      const enum outcome now_is = step(words, count);
      if (now_is > outcome) outcome = now_is;
    }
  }
  if (list) return 0;
  if (counts[0] + counts[1] + counts[2] + left == 0) die("no case is named so");
  printf("%u equal, %u different, %u failed, %u not run; %.0f s\n", counts[equal],
         counts[different], counts[failed], left, now() - all.begin);
  return counts[different] + counts[failed] > 0 ? 1 : left > 0 ? 3 : 0;
}

int main(int count, char** arguments) {
  const char *device = NULL, *library = NULL;
  bool list = false;
  int first = 2;
  all.seconds = 540;
  all.begin = now();
  if (count < 2) die("wanted FOLDER [OPTION...] [CASE...]");
  all.folder = arguments[1];
  for (; first < count && strncmp(arguments[first], "--", 2) == 0; ++first) {
    const char* option = arguments[first];
    list = list || strcmp(option, "--list") == 0;
    if (strcmp(option, "--list") == 0) continue;
    if (++first == count) die("%s needs a value", option);
    if (strcmp(option, "--device") == 0)
      device = arguments[first];
    else if (strcmp(option, "--library") == 0)
      library = arguments[first];
    else if (strcmp(option, "--seconds") == 0)
      all.seconds = strtod(arguments[first], NULL);
    else
      die("unknown option %s", option);
  }
  /* PoCL as tracer/device/pocl_environment.cc has it; nothing that was compiled before is taken. */
  setenv("POCL_KERNEL_CACHE", "0", 0);
  setenv("POCL_WORK_GROUP_SPECIALIZATION", "0", 0);
  setenv("CUDA_CACHE_DISABLE", "1", 0);
  all.device = open_device(device, library, list);
  size_t size = 0;
  all.cases = read_file("cases.txt", &size);
  all.data = read_file("data.bin", &all.data_size);
  return run_cases(arguments + first, count - first, list);
}
