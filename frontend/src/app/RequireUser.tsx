/** The door: whoever is not signed in signs in first, then comes back to where they wanted to go. */
import { Loader } from "@mantine/core";
import { useEffect } from "react";
import { useTranslation } from "react-i18next";
import { Navigate, Outlet, useLocation } from "react-router-dom";
import { useMe } from "@/api/queries";
import { noteVisit } from "./begun";
import { LoadProblem } from "./LoadProblem";
import styles from "./shell.module.css";

export function Waiting() {
  const { t } = useTranslation();
  return (
    <div className={styles.waiting} role="status">
      <Loader size="sm" aria-hidden="true" />
      <span className="visually-hidden">{t("shell.loading")}</span>
    </div>
  );
}

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
