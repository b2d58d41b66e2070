/** Says on every screen, to those who can do something about it, that a part of VIPO is dead or its clock is off. */
import { CircleAlert } from "lucide-react";
import { useTranslation } from "react-i18next";
import { Link, useLocation } from "react-router-dom";
import { useFindings, useSite } from "@/api/queries";
import styles from "../shell.module.css";
import { findingWords, gravest, pageOf, seesOperations } from "./findings";

export function FindingsStrip({ slug }: { slug: string }) {
  const { t } = useTranslation();
  const role = useSite(slug).data?.role;
  const page = `/sites/${slug}/operations`;
  const isThere = useLocation().pathname === page;
  const findings = gravest(useFindings(seesOperations(role) && !isThere ? slug : undefined).data ?? []);
  const [first, ...others] = findings;
  return (
    <div role="status" className={first ? `${styles.strip} ${styles.grave}` : "visually-hidden"}>
      {first ? (
        <>
          <CircleAlert size={15} aria-hidden="true" />
          <span>
            {findingWords(first)}
            {others.length > 0 ? ` ${t("operations.more", { count: others.length })}` : ""}
          </span>
          <Link to={pageOf(first, slug)} className={styles.stripLink}>
            {t("operations.look")}
          </Link>
        </>
      ) : null}
    </div>
  );
}
