#include "csv.h"

#include "status.h"

void csv_write_header(FILE *stream) {
    fputs("frame,x,y,w,h,scale,score,status\n", stream);
}

void csv_write_row(FILE *stream, int32_t number, const ast_result *result) {
    fprintf(stream, "%d,%.4f,%.4f,%.4f,%.4f,%.6f,%.6f,%s\n", (int)number, (double)result->box.x, (double)result->box.y,
            (double)result->box.w, (double)result->box.h, (double)result->scale, (double)result->score,
            status_name(result->status));
}
