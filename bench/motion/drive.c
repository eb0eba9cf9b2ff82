/* Runs jobs from standard input: one motion by one method, its end state and its time.
 *
 * A job is a line: method, step or tolerance, duration, steps, sample after so many steps (0: only
 * at the end), rounds; then PARAMETERS parameters, attitude (4), omega (3). The answer is a line:
 * passes, nanoseconds of the fastest round, then every state that was sampled, seven numbers each.
 * With the argument "count" it only goes through the motions and dumps callgrind's counts: one for
 * what is done once a motion, one for the steps.
 */
#include "methods.h"
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <valgrind/callgrind.h>

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return 1e9 * (double)t.tv_sec + (double)t.tv_nsec;
}

static void show(const method *by)
{
    double state[7];
    by->state(state);
    for (int i = 0; i < 7; i++) {
        printf(" %a", state[i]);
    }
}

static void answer(const method *by, const double *given, job what)
{
    double best = 1e300;
    long passes = 0;
    for (int round = 0; round < what.rounds; round++) {
        const double before = now();
        by->start(given, what.step, what.duration);
        passes = by->go(what.steps);
        const double took = now() - before;
        best = took < best ? took : best;
    }
    printf("%ld %.0f", passes, best);
    if (what.every > 0) {
        by->start(given, what.step, what.duration);
        for (long done = 0; done < what.steps; done += what.every) {
            by->go(what.every);
            show(by);
        }
    } else {
        show(by);
    }
    printf("\n");
}

static void count(const method *by, const double *given, job what)
{
    CALLGRIND_ZERO_STATS;
    by->start(given, what.step, what.duration);
    CALLGRIND_DUMP_STATS_AT("start");
    CALLGRIND_ZERO_STATS;
    const long passes = by->go(what.steps);
    CALLGRIND_DUMP_STATS_AT("go");
    printf("%ld\n", passes);
}

int main(int arguments, char **argument)
{
    const int counting = arguments > 1 && strcmp(argument[1], "count") == 0;
    double parameters[PARAMETERS + 1], given[7];
    int which;
    job what;
    while (scanf("%d %lf %lf %ld %ld %d", &which, &what.step, &what.duration, &what.steps,
                 &what.every, &what.rounds) == 6) {
        for (int i = 0; i < PARAMETERS + 7; i++) {
            double *to = i < PARAMETERS ? &parameters[i] : &given[i - PARAMETERS];
            if (scanf("%la", to) != 1) {
                return 1;
            }
        }
        if (methods[which].prepare(parameters) != 0) {
            printf("refused\n");
            continue;
        }
        (counting ? count : answer)(&methods[which], given, what);
    }
    return 0;
}
