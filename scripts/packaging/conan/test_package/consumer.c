#include <singe/singe.h>
#include <stdio.h>

int main(void) {
    printf("singe %s\n", singe_version());
    return 0;
}
