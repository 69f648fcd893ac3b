/* sheet.h - surfaces into samples, and these into bins, in the blocks that the present pass bakes. */
#ifndef ASET_APPROX_SHEET_H
#define ASET_APPROX_SHEET_H

#include "approx/baker.h"

#if ASET_WITH_DRAFTS

/* points are the scene's, and are written over; crossings: room for n. */
void aset_sheet_polygon(aset_baker *b, aset_real *points, uint32_t n, aset_real *crossings);
void aset_sheet_triangles(aset_baker *b, const aset_real *points, size_t n);
#if ASET_WITH_SPHERES
void aset_sheet_sphere(aset_baker *b, aset_vec3 centre, aset_real radius);
#endif
#if ASET_WITH_CONES
void aset_sheet_cone(aset_baker *b, aset_vec3 base, aset_real base_radius, aset_vec3 apex, aset_real apex_radius);
#endif

#endif
#endif
