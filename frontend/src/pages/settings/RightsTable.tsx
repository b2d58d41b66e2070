/** Who may do what: sentences and roles, as the server's one table has it. */
import { Check } from "lucide-react";
import { useTranslation } from "react-i18next";
import type { Deed } from "@/api/types";
import { Panel } from "@/design/Panel";
import pages from "../pages.module.css";
import { ROLES } from "./RoleSelect";
import styles from "./settings.module.css";

function Mark({ may }: { may: boolean }) {
  const { t } = useTranslation();
  return (
    <span className={styles.mark} data-may={may || undefined}>
      {may ? <Check size={14} strokeWidth={2.5} aria-hidden="true" /> : <span aria-hidden="true">–</span>}
      <span className="visually-hidden">{t(may ? "people.rights.yes" : "people.rights.no")}</span>
    </span>
  );
}

export function RightsTable({ deeds }: { deeds: Deed[] }) {
  const { t } = useTranslation();
  return (
    <Panel className={styles.section} aria-label={t("people.rights.title")}>
      <div className={styles.head}>
        <h2>{t("people.rights.title")}</h2>
        <span>{t("people.rights.note")}</span>
      </div>
      <div className={pages.scroll}>
        <table className={`${pages.table} ${styles.rights}`}>
          <thead>
            <tr>
              <th scope="col">
                <span className="visually-hidden">{t("people.rights.deed")}</span>
              </th>
              {ROLES.map((role) => (
                <th key={role} scope="col">
                  {t(`role.${role}`)}
                </th>
              ))}
            </tr>
          </thead>
          <tbody>
            {deeds.map((deed) => (
              <tr key={deed.name}>
                <th scope="row">{t(`people.deed.${deed.name}`)}</th>
                {ROLES.map((role) => (
                  <td key={role}>
                    <Mark may={deed.roles.includes(role)} />
                  </td>
                ))}
              </tr>
            ))}
          </tbody>
        </table>
      </div>
    </Panel>
  );
}
