/* What the harness asks of a board, and of the host. */
#include <stdint.h>

extern uint32_t bss_start, bss_end;
int main(void);
void say(const char *text);
uint32_t ticks(void);
