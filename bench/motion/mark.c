/* Marks in a run under callgrind, called from Python through ctypes. */
#include <valgrind/callgrind.h>

void mark_begin(void) { CALLGRIND_ZERO_STATS; }

void mark_end(void) { CALLGRIND_DUMP_STATS_AT("marked"); }
