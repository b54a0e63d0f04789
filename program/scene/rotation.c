// With half angles a, b, c about x, y, z the quaternion of R = Rz Ry Rx is q = qz qy qx:
//   x = sa cb cc - ca sb sc      y = ca sb cc + sa cb sc
//   z = ca cb sc - sa sb cc      w = ca cb cc + sa sb sc
#include "scene/rotation.h"

#include <math.h>

void rotation_quaternion(const float angles[3], float quaternion[4]) {
    double s[3], c[3];
    for (int i = 0; i < 3; i++) {
        s[i] = sin((double)angles[i] / 2);
        c[i] = cos((double)angles[i] / 2);
    }

    quaternion[0] = (float)(s[0] * c[1] * c[2] - c[0] * s[1] * s[2]);
    quaternion[1] = (float)(c[0] * s[1] * c[2] + s[0] * c[1] * s[2]);
    quaternion[2] = (float)(c[0] * c[1] * s[2] - s[0] * s[1] * c[2]);
    quaternion[3] = (float)(c[0] * c[1] * c[2] + s[0] * s[1] * s[2]);
}

void rotation_matrix(const float angles[3], double matrix[9]) {
    double s[3], c[3];
    for (int i = 0; i < 3; i++) {
        s[i] = sin((double)angles[i]);
        c[i] = cos((double)angles[i]);
    }

    matrix[0] = c[2] * c[1];
    matrix[1] = c[2] * s[1] * s[0] - s[2] * c[0];
    matrix[2] = c[2] * s[1] * c[0] + s[2] * s[0];
    matrix[3] = s[2] * c[1];
    matrix[4] = s[2] * s[1] * s[0] + c[2] * c[0];
    matrix[5] = s[2] * s[1] * c[0] - c[2] * s[0];
    matrix[6] = -s[1];
    matrix[7] = c[1] * s[0];
    matrix[8] = c[1] * c[0];
}
