/** From which role on the site demands a second factor; set by its admins, at once. */
import { NativeSelect } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { useTranslation } from "react-i18next";
import { Link } from "react-router-dom";
import type { FactorRule as Rule } from "@/api/types";
import { Panel } from "@/design/Panel";
import { LoadProblem } from "@/shell/LoadProblem";
import { tellRefusal } from "@/shell/refusal";
import { TableSkeleton } from "../TableSkeleton";
import { useFactorRule, useMembers, useSetFactorRule } from "./people";
import styles from "./settings.module.css";

type Demanded = Rule["demanded_from"];
const ROLES: readonly NonNullable<Demanded>[] = ["commenter", "operator", "author", "admin"];

export function FactorRule({ slug }: { slug: string }) {
  const { t } = useTranslation();
  const rule = useFactorRule(slug);
  const set = useSetFactorRule(slug);
  const lacksOwn = useMembers(slug).data?.some(({ me, second_factor: has }) => me && !has);
  if (rule.isLoadingError) return <LoadProblem error={rule.error} again={() => void rule.refetch()} />;
  if (!rule.data) return <TableSkeleton />;
  const { demanded_from: demanded, of_server: ofServer } = rule.data;
  /** The answer is told also where nobody looks at this any more. Until then nothing else is chosen. */
  const choose = async (role: Demanded) => {
    if (set.isPending) return;
    await set.mutateAsync(role).then(
      () => notifications.show({ message: t("factor.rule.saved") }),
      (error: Error) => tellRefusal(error, t),
    );
  };
  return (
    <Panel className={styles.section} role="region" aria-labelledby="factor-rule">
      <div className={styles.head}>
        <h2 id="factor-rule">{t("factor.rule.title")}</h2>
      </div>
      <div className={styles.rule}>
        <NativeSelect
          label={t("factor.rule.label")}
          description={t("factor.rule.text")}
          value={set.isPending ? (set.variables ?? "") : (demanded ?? "")}
          aria-disabled={set.isPending} // and not disabled: the field keeps the focus
          onChange={(event) => void choose((event.currentTarget.value || null) as Demanded)}
        >
          <option value="">{t("factor.rule.nobody")}</option>
          {ROLES.map((role) => (
            <option key={role} value={role}>
              {t(role === "admin" ? "factor.rule.admins" : "factor.rule.from", { role: t(`role.${role}`) })}
            </option>
          ))}
        </NativeSelect>
        {ofServer ? <p>{t("factor.rule.ofServer", { role: t(`role.${ofServer}`) })}</p> : null}
        {lacksOwn ? (
          <p>
            {t("factor.rule.own")} <Link to="/account">{t("factor.toAccount")}</Link>
          </p>
        ) : null}
      </div>
    </Panel>
  );
}
