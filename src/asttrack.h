/* The public header, where Arduino's builder looks for it: that knows a library's src/ alone. */
#include "../include/asttrack.h"
