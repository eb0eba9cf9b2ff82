/* A method of motion as the driver knows it. */
#ifndef DRIVE_H
#define DRIVE_H

typedef struct {
    double step, duration;
    long steps, every;
    int rounds;
} job;

typedef struct {
    int (*prepare)(const double *parameters);                          /* once a body */
    void (*start)(const double *state, double step, double duration); /* once a motion */
    long (*go)(long steps); /* returns passes; an adaptive method goes to the end */
    void (*state)(double *state);
} method;

extern const method methods[];

#endif
