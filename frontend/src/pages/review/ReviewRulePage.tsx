/** What a site demands before a program may run on its devices; for admins. */
import { Button, NativeSelect } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { type FormEvent, useState } from "react";
import { useTranslation } from "react-i18next";
import { useParams } from "react-router-dom";
import { missing } from "@/api/failed";
import { useSite } from "@/api/queries";
import type { ReviewRule } from "@/api/types";
import { EmptyState } from "@/design/EmptyState";
import { Panel } from "@/design/Panel";
import { LoadProblem, problemText } from "@/shell/LoadProblem";
import { PageShell } from "@/shell/PageShell";
import { type LeastRole, useReviewRule, useSetReviewRule } from "@/shell/review/review";
import pages from "../pages.module.css";
import { SettingsTabs } from "../settings/SettingsTabs";
import { TableSkeleton } from "../TableSkeleton";
import styles from "./review.module.css";

const MOST = 9;
const ROLES: readonly LeastRole[] = ["operator", "author", "admin"];

export function ReviewRulePage() {
  const { slug = "" } = useParams();
  return <RuleOfSite key={slug} slug={slug} />;
}

function RuleOfSite({ slug }: { slug: string }) {
  const { t } = useTranslation();
  const site = useSite(slug);
  const rule = useReviewRule(slug);
  const problem = missing(site, rule);
  return (
    <PageShell title={t("review.rule.title")}>
      <SettingsTabs slug={slug} role={site.data?.role} />
      <div className={pages.stack}>
        {problem ? (
          <LoadProblem error={problem} again={() => void Promise.all([site.refetch(), rule.refetch()])} />
        ) : null}
        {site.data && site.data.role !== "admin" ? (
          <Panel>
            <EmptyState title={t("review.rule.notForYou")} />
          </Panel>
        ) : null}
        {!problem && !rule.data ? <TableSkeleton /> : null}
        {rule.data && site.data?.role === "admin" ? <RuleForm slug={slug} rule={rule.data} /> : null}
      </div>
    </PageShell>
  );
}

function RuleForm({ slug, rule }: { slug: string; rule: ReviewRule }) {
  const { t } = useTranslation();
  const save = useSetReviewRule(slug);
  const [chosen, setChosen] = useState(rule);
  const onSubmit = (event: FormEvent) => {
    event.preventDefault();
    save.mutate(chosen, {
      onSuccess: () => notifications.show({ message: t("review.rule.saved") }),
      onError: (error) => notifications.show({ color: "red", message: problemText(error, t("shell.problem.screen")) }),
    });
  };
  const counts = Array.from({ length: MOST + 1 }, (_, count) => ({
    value: String(count),
    label: count === 0 ? t("review.rule.none") : String(count),
  }));
  return (
    <Panel className={styles.rule} aria-label={t("review.rule.heading")}>
      <h2>{t("review.rule.heading")}</h2>
      <p>{t("review.rule.intro")}</p>
      <form onSubmit={onSubmit} className={styles.fields}>
        <NativeSelect
          label={t("review.rule.approvals")}
          data={counts}
          value={String(chosen.approvals)}
          onChange={(event) => setChosen({ ...chosen, approvals: Number(event.currentTarget.value) })}
        />
        <NativeSelect
          label={t("review.rule.least")}
          data={ROLES.map((value) => ({ value, label: t(`review.rule.role.${value}`) }))}
          value={chosen.least_role}
          onChange={(event) => setChosen({ ...chosen, least_role: event.currentTarget.value as LeastRole })}
        />
        <Button type="submit" className={styles.save} loading={save.isPending}>
          {t("review.rule.save")}
        </Button>
      </form>
      <p>{t("review.rule.own")}</p>
    </Panel>
  );
}
