#include "local_expansion.hpp"

namespace keeler::gravity {
namespace {

void complete2(float* t) {
  enum { xx, xy, xz, yy, yz, zz };
  const float third = (t[xx] + t[yy] + t[zz]) / 3.0F;
  t[xx] -= third;
  t[yy] -= third;
  t[zz] -= third;
}

void complete3(float* t) {
  enum { xxx, xxy, xxz, xyy, xyz, xzz, yyy, yyz, yzz, zzz };
  const float x = (t[xxx] + t[xyy] + t[xzz]) / 5.0F;
  const float y = (t[xxy] + t[yyy] + t[yzz]) / 5.0F;
  const float z = (t[xxz] + t[yyz] + t[zzz]) / 5.0F;
  t[xxx] -= 3.0F * x;
  t[xxy] -= y;
  t[xxz] -= z;
  t[xyy] -= x;
  t[xzz] -= x;
  t[yyy] -= 3.0F * y;
  t[yyz] -= z;
  t[yzz] -= y;
  t[zzz] -= 3.0F * z;
}

void complete4(float* t) {
  enum { xxxx, xxxy, xxxz, xxyy, xxyz, xxzz, xyyy, xyyz, xyzz, xzzz, yyyy, yyyz, yyzz, yzzz, zzzz };
  const float xx = (t[xxxx] + t[xxyy] + t[xxzz]) / 7.0F, xy = (t[xxxy] + t[xyyy] + t[xyzz]) / 7.0F;
  const float xz = (t[xxxz] + t[xyyz] + t[xzzz]) / 7.0F, yy = (t[xxyy] + t[yyyy] + t[yyzz]) / 7.0F;
  const float yz = (t[xxyz] + t[yyyz] + t[yzzz]) / 7.0F, zz = (t[xxzz] + t[yyzz] + t[zzzz]) / 7.0F;
  const float whole = (xx + yy + zz) / 5.0F;
  t[xxxx] -= 6.0F * xx - 3.0F * whole;
  t[xxxy] -= 3.0F * xy;
  t[xxxz] -= 3.0F * xz;
  t[xxyy] -= xx + yy - whole;
  t[xxyz] -= yz;
  t[xxzz] -= xx + zz - whole;
  t[xyyy] -= 3.0F * xy;
  t[xyyz] -= xz;
  t[xyzz] -= xy;
  t[xzzz] -= 3.0F * xz;
  t[yyyy] -= 6.0F * yy - 3.0F * whole;
  t[yyyz] -= 3.0F * yz;
  t[yyzz] -= yy + zz - whole;
  t[yzzz] -= 3.0F * yz;
  t[zzzz] -= 6.0F * zz - 3.0F * whole;
}

} // namespace

void complete(LocalTerms& terms) {
  complete2(terms.rank2);
  complete3(terms.rank3);
  complete4(terms.rank4);
}

} // namespace keeler::gravity
