#include "csv.h"

#include "status.h"

void csv_write_header(output_file *output) {
    output_print(output, "frame,x,y,w,h,scale,score,status\n");
}

void csv_write_row(output_file *output, int32_t number, const ast_result *result) {
    output_print(output, "%d,%.4f,%.4f,%.4f,%.4f,%.6f,%.6f,%s\n", (int)number, (double)result->box.x, (double)result->box.y,
                 (double)result->box.w, (double)result->box.h, (double)result->scale, (double)result->score,
                 status_name(result->status));
}
