/* Rates of the six states of a heavy symmetrical top, in the axes that do not spin with it. */
#ifndef MINIMUM_HEAVY_TOP_H
#define MINIMUM_HEAVY_TOP_H

typedef struct {
    double ratio;  /* C / A */
    double weight; /* m g l / A */
} constants;

void setup(const double *p, constants *k);
void evaluate(const constants *k, const double *state, double *rate);

#endif
