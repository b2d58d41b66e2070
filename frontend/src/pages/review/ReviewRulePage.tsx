/** What a site demands before a program may run on its devices; for admins. */
import { NativeSelect } from "@mantine/core";
import { useTranslation } from "react-i18next";
import { keys } from "@/api/queries";
import type { ReviewRule } from "@/api/types";
import { MOST_APPROVALS } from "../settings/bounds";
import { SettingForm } from "../settings/SettingForm";
import { SettingsPage } from "../settings/SettingsPage";
import { useSetSetting, useTouched } from "../settings/siteSetting";

type LeastRole = ReviewRule["least_role"];
const ROLES: readonly LeastRole[] = ["operator", "author", "admin"];
const PATH = "review-rule";

export function ReviewRulePage() {
  const { t } = useTranslation();
  return (
    <SettingsPage<ReviewRule> path={PATH} title={t("review.rule.title")} notForYou={t("review.rule.notForYou")}>
      {(rule, slug) => <RuleForm slug={slug} rule={rule} />}
    </SettingsPage>
  );
}

function RuleForm({ slug, rule }: { slug: string; rule: ReviewRule }) {
  const { t } = useTranslation();
  const save = useSetSetting<ReviewRule, ReviewRule>({
    ...{ slug, path: PATH, saved: t("review.rule.saved"), touches: keys.reviews },
  });
  const { fields: chosen, touched, touch, settle } = useTouched(rule);
  const counts = Array.from({ length: MOST_APPROVALS + 1 }, (_, count) => ({
    value: String(count),
    label: count === 0 ? t("review.rule.none") : String(count),
  }));
  return (
    <SettingForm
      heading={t("review.rule.heading")}
      intro={t("review.rule.intro")}
      foot={t("review.rule.own")}
      isSaving={save.isPending}
      onSave={() => save.mutate(touched, { onSuccess: () => settle(touched) })}
    >
      <NativeSelect
        label={t("review.rule.approvals")}
        data={counts}
        value={String(chosen.approvals)}
        onChange={(event) => touch({ approvals: Number(event.currentTarget.value) })}
      />
      <NativeSelect
        label={t("review.rule.least")}
        data={ROLES.map((value) => ({ value, label: t(`review.rule.role.${value}`) }))}
        value={chosen.least_role}
        onChange={(event) => touch({ least_role: event.currentTarget.value as LeastRole })}
      />
    </SettingForm>
  );
}
