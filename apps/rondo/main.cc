#include "driver/main.h"

int main(int argc, char** argv) { return rondo::driver::Main(argc, argv); }
