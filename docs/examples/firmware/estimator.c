/* Attitude of a satellite by an extended Kalman filter, a thousand times a second.
 *
 * The filter predicts by estimator_step_rk4_tangent: the next state, and how small errors of the
 * attitude, the angular velocity and the moment grow into those of the next state, exactly as the
 * step maps them. A gyro is read in every cycle, a star tracker in every hundredth. */
#include "estimator_f32.h"
#include "told.h"

#define CYCLES 10000
#define STEP 1e-3F /* s */
#define GYRO 1e-3F /* rad/s, of a reading */
#define STARS 1e-4F /* rad, of an axis */
#define PUSH 0.01F /* N m, of what pushes and nobody knows */

typedef struct {
    float attitude[4], omega[3];
    float P[6][6]; /* covariance of the turn to the true attitude and of omega */
} estimate;

static void predict(const estimator_constants_f32 *known, estimate *of, const float moment[3])
{
    float J[54], FP[6][6]; /* column by column: by the turn, by omega, by the moment */
    estimator_step_rk4_tangent_dense_f32(
        known, of->attitude, of->omega, moment, STEP, of->attitude, of->omega, J);
    for (int i = 0; i < 6; i++) {
        for (int j = 0; j < 6; j++) {
            float sum = 0.0F;
            for (int k = 0; k < 6; k++) {
                sum += J[i + 6 * k] * of->P[k][j];
            }
            FP[i][j] = sum;
        }
    }
    for (int i = 0; i < 6; i++) {
        for (int j = 0; j <= i; j++) {
            float sum = 0.0F, pushed = 0.0F;
            for (int k = 0; k < 6; k++) {
                sum += FP[i][k] * J[j + 6 * k];
            }
            for (int k = 6; k < 9; k++) {
                pushed += J[i + 6 * k] * J[j + 6 * k];
            }
            of->P[i][j] = of->P[j][i] = sum + PUSH * PUSH * pushed;
        }
    }
}

/* Take in three readings: each is entry first + i of the error, with a variance. */
static void correct(estimate *of, const float apart[3], int first, float variance)
{
    float error[6] = {0.0F};
    for (int i = first; i < first + 3; i++) {
        float gain[6];
        const float left = apart[i - first] - error[i];
        const float over = 1.0F / (of->P[i][i] + variance);
        for (int k = 0; k < 6; k++) {
            gain[k] = of->P[k][i] * over;
            error[k] += gain[k] * left;
        }
        float row[6];
        memcpy(row, of->P[i], sizeof row);
        for (int k = 0; k < 6; k++) {
            for (int l = 0; l <= k; l++) {
                of->P[k][l] = of->P[l][k] = of->P[k][l] - gain[k] * row[l];
            }
        }
    }
    turned(of->attitude, error);
    for (int i = 0; i < 3; i++) {
        of->omega[i] += error[3 + i];
    }
}

static void cycle(const estimator_constants_f32 *known, estimate *of, const float moment[3],
    const float gyro[3], const float *stars)
{
    float apart[3];
    predict(known, of, moment);
    for (int i = 0; i < 3; i++) {
        apart[i] = gyro[i] - of->omega[i];
    }
    correct(of, apart, 3, GYRO * GYRO);
    if (stars) {
        turn_between(of->attitude, stars, apart);
        correct(of, apart, 0, STARS * STARS);
    }
}

int main(void)
{
    estimator_constants_f32 known;
    const float moment[3] = {0.02F, -0.01F, 0.015F};
    float attitude[4] = {1.0F, 0.0F, 0.0F, 0.0F}, omega[3] = {0.2F, -0.1F, 0.3F}; /* the true ones */
    estimate of = {{1.0F, 0.004F, -0.003F, 0.002F}, {0.0F, 0.0F, 0.0F}, {{0.0F}}};
    float turn[3], error = 0.0F, expected = 0.0F;
    if (estimator_setup_f32(3.0F, 4.0F, 5.0F, &known) != 0) {
        return 1;
    }
    for (int i = 0; i < 6; i++) {
        of.P[i][i] = i < 3 ? 1e-4F : 0.1F;
    }
    uint32_t idle = ticks();
    idle = ticks() - idle;
    for (int n = 1; n <= CYCLES; n++) {
        float pushed[3], gyro[3], stars[4];
        for (int i = 0; i < 3; i++) {
            pushed[i] = moment[i] + PUSH * normal();
        }
        estimator_step_rk4_f32(&known, attitude, omega, pushed, STEP, attitude, omega);
        for (int i = 0; i < 3; i++) {
            gyro[i] = omega[i] + GYRO * normal();
            turn[i] = STARS * normal();
        }
        memcpy(stars, attitude, sizeof stars);
        turned(stars, turn);
        const uint32_t before = ticks();
        cycle(&known, &of, moment, gyro, n % 100 == 0 ? stars : (const float *)0);
        timed(ticks() - before, idle);
        take(of.attitude, 4);
        take(of.omega, 3);
        take(of.P[0], 36);
        if (n > CYCLES / 2) {
            turn_between(of.attitude, attitude, turn);
            error += squared(turn);
            expected += of.P[0][0] + of.P[1][1] + of.P[2][2];
        }
    }
    tell("error", millionths(sqrtf(error / (CYCLES / 2))));
    tell("expected", millionths(sqrtf(expected / (CYCLES / 2))));
    tell_all();
    return 0;
}
