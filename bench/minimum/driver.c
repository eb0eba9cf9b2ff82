/* Calls one function of one tool. glue.h, written for that tool, says how: it gives PARAMETERS,
 * INPUTS, OUTPUTS and SAMPLES, the types `arguments` and `results`, and load, call and store.
 *   driver          reads rows of parameters and inputs, writes rows of outputs
 *   driver N        reads SAMPLES rows, calls the function on each of them N times over */
#include <stdio.h>
#include <stdlib.h>

#include "glue.h"

static arguments table[SAMPLES];
static results answer;

static int next(arguments *given)
{
    double row[PARAMETERS + INPUTS];
    if (fread(row, sizeof row, 1, stdin) != 1) {
        return 0;
    }
    load(row, row + PARAMETERS, given);
    return 1;
}

static int answers(void)
{
    double row[OUTPUTS];
    while (next(&table[0])) {
        call(&table[0], &answer);
        store(&answer, row);
        if (fwrite(row, sizeof row, 1, stdout) != 1) {
            return 1;
        }
    }
    return 0;
}

static int calls(long rounds)
{
    for (int i = 0; i < SAMPLES; i++) {
        if (!next(&table[i])) {
            return 1;
        }
    }
    for (; rounds > 0; rounds--) {
        for (arguments *given = table; given < table + SAMPLES; given++) {
            call(given, &answer);
        }
    }
    return 0;
}

int main(int argc, char **argv)
{
    return argc > 1 ? calls(atol(argv[1])) : answers();
}
