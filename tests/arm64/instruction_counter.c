// SPDX-License-Identifier: BSD-3-Clause
// Plugin of qemu-user: counts the instructions that are executed from the entry of a function to its return, with all
// that it calls. Arguments: out=FILE, then any number of NAME=SYMBOL, a mangled symbol of the program. Writes a line
// "NAME calls instructions" for each to FILE when the program ends.
//
// A call is seen where the first block of a function runs; it ends where the block runs that follows the calling one
// in memory. So a function that is reached by a jump, as a tail call is, never ends, and one that calls itself is
// counted more than once: such are not named.
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// The part of qemu-plugin.h that is used; Debian has no package of it.
typedef uint64_t qemu_plugin_id_t;
struct qemu_plugin_tb;
struct qemu_plugin_insn;
void qemu_plugin_register_vcpu_tb_trans_cb(qemu_plugin_id_t, void (*)(qemu_plugin_id_t, struct qemu_plugin_tb*));
void qemu_plugin_register_vcpu_tb_exec_cb(struct qemu_plugin_tb*, void (*)(unsigned, void*), int flags, void*);
void qemu_plugin_register_atexit_cb(qemu_plugin_id_t, void (*)(qemu_plugin_id_t, void*), void*);
size_t qemu_plugin_tb_n_insns(const struct qemu_plugin_tb*);
uint64_t qemu_plugin_tb_vaddr(const struct qemu_plugin_tb*);
struct qemu_plugin_insn* qemu_plugin_tb_get_insn(const struct qemu_plugin_tb*, size_t);
const char* qemu_plugin_insn_symbol(const struct qemu_plugin_insn*);
__attribute__((visibility("default"))) int qemu_plugin_version = 1;

enum { kMostFunctions = 64, kMostThreads = 64, kMostDepth = 64, kInstructionBytes = 4 };

struct Function {
  const char* name;
  const char* symbol;
  uint64_t first;  // address of its first block, 0: not seen
  uint64_t calls, instructions;
};
static struct Function functions[kMostFunctions];
static int function_count;
static const char* out_path;

struct Block {
  uint64_t start, end, instructions;
  struct Function* entered;
};

struct Thread {
  uint64_t end_of_last;
  int depth;
  struct {
    struct Function* function;
    uint64_t back;
  } calls[kMostDepth];
};
static struct Thread threads[kMostThreads];

// Runs before each block.
static void OnBlock(unsigned cpu, void* data) {
  const struct Block* block = data;
  struct Thread* thread = &threads[cpu % kMostThreads];
  while (thread->depth > 0 && thread->calls[thread->depth - 1].back == block->start) --thread->depth;
  if (block->entered && thread->depth < kMostDepth) {
    __atomic_fetch_add(&block->entered->calls, 1, __ATOMIC_RELAXED);
    thread->calls[thread->depth].function = block->entered;
    thread->calls[thread->depth].back = thread->end_of_last;
    ++thread->depth;
  }
  for (int i = 0; i < thread->depth; ++i) {
    __atomic_fetch_add(&thread->calls[i].function->instructions, block->instructions, __ATOMIC_RELAXED);
  }
  thread->end_of_last = block->end;
}

// The first block of a symbol that is translated is its entry.
static struct Function* EnteredAt(const char* symbol, uint64_t address) {
  if (!symbol) return NULL;
  for (int i = 0; i < function_count; ++i) {
    struct Function* function = &functions[i];
    if (strcmp(function->symbol, symbol) != 0) continue;
    if (function->first == 0) function->first = address;
    if (function->first == address) return function;
  }
  return NULL;
}

static void OnTranslation(qemu_plugin_id_t id, struct qemu_plugin_tb* tb) {
  (void)id;
  struct Block* block = malloc(sizeof(*block));
  block->start = qemu_plugin_tb_vaddr(tb);
  block->instructions = qemu_plugin_tb_n_insns(tb);
  block->end = block->start + kInstructionBytes * block->instructions;
  block->entered = EnteredAt(qemu_plugin_insn_symbol(qemu_plugin_tb_get_insn(tb, 0)), block->start);
  qemu_plugin_register_vcpu_tb_exec_cb(tb, OnBlock, 0, block);
}

static void OnEnd(qemu_plugin_id_t id, void* data) {
  (void)id, (void)data;
  FILE* out = fopen(out_path, "w");
  if (!out) return;
  for (int i = 0; i < function_count; ++i) {
    fprintf(out, "%s %llu %llu\n", functions[i].name, (unsigned long long)functions[i].calls,
            (unsigned long long)functions[i].instructions);
  }
  fclose(out);
}

__attribute__((visibility("default"))) int qemu_plugin_install(qemu_plugin_id_t id, const void* info, int argc,
                                                                char** argv) {
  (void)info;
  for (int i = 0; i < argc; ++i) {
    char* const name = strdup(argv[i]);
    char* const value = strchr(name, '=');
    if (!value) return -1;
    *value = '\0';
    if (strcmp(name, "out") == 0) {
      out_path = value + 1;
    } else if (function_count < kMostFunctions) {
      functions[function_count].name = name;
      functions[function_count++].symbol = value + 1;
    }
  }
  if (!out_path) return -1;
  qemu_plugin_register_vcpu_tb_trans_cb(id, OnTranslation);
  qemu_plugin_register_atexit_cb(id, OnEnd, NULL);
  return 0;
}
