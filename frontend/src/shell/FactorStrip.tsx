/** Leads who lacks the second factor that the site demands of their role to where it is set up. */
import { ShieldAlert } from "lucide-react";
import { useTranslation } from "react-i18next";
import { Link, useLocation } from "react-router-dom";
import { useSite } from "@/api/queries";
import styles from "./shell.module.css";

export function FactorStrip({ slug }: { slug: string }) {
  const { t } = useTranslation();
  const held = useSite(slug).data?.held_role;
  const isThere = useLocation().pathname === "/account";
  return (
    <div role="status" className={held ? styles.strip : "visually-hidden"}>
      {held ? (
        <>
          <ShieldAlert size={15} aria-hidden="true" />
          <span>{t("factor.held", { role: t(`role.${held}`) })}</span>
          {isThere ? null : (
            <Link to="/account" className={styles.stripLink}>
              {t("factor.toAccount")}
            </Link>
          )}
        </>
      ) : null}
    </div>
  );
}
