/** Whoever is not signed in signs in first, then comes back to where they wanted to go. */
import { useEffect } from "react";
import { Navigate, Outlet, useLocation } from "react-router-dom";
import { useMe } from "@/api/queries";
import { noteVisit } from "@/shell/triedSteps";
import { LoadProblem, Waiting } from "@/shell/LoadProblem";

export function RequireUser() {
  const me = useMe();
  const { pathname, search } = useLocation();
  useEffect(() => noteVisit(pathname), [pathname]);
  if (me.isPending) return <Waiting />;
  if (me.isLoadingError) return <LoadProblem error={me.error} again={() => void me.refetch()} />;
  if (!me.data.user) {
    const next = pathname === "/" ? "" : `?next=${encodeURIComponent(pathname + search)}`;
    return <Navigate to={`/sign-in${next}`} replace />;
  }
  return <Outlet />;
}
