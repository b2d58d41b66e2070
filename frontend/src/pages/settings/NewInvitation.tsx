/** The form for a new invitation, and its link, shown this one time. */
import { Button, Modal, NativeSelect, Radio, TextInput } from "@mantine/core";
import { useState } from "react";
import { useTranslation } from "react-i18next";
import { SecretField } from "@/design/SecretField";
import type { MadeInvitation, Role } from "@/api/types";
import { useReturnFocus } from "@/design/useReturnFocus";
import { problemText } from "@/shell/LoadProblem";
import { useTellUnseen } from "@/shell/refusal";
import pages from "../pages.module.css";
import { useInvite } from "./people";
import { ROLES } from "./RoleSelect";
import styles from "./settings.module.css";

const DAYS = [1, 7, 30, 90];
const USES = [1, 5, 20, 100];
const FRESH: { role: Role; days: number; uses: number; email: string } = {
  role: "author",
  days: 7,
  uses: 1,
  email: "",
};

interface Props {
  slug: string;
  canMail: boolean;
  onMade: (invitation: MadeInvitation) => void;
  onClose: () => void;
}

interface FieldsProps {
  wanted: typeof FRESH;
  set: (some: Partial<typeof FRESH>) => void;
  canMail: boolean;
}

function Fields({ wanted, set, canMail }: FieldsProps) {
  const { t } = useTranslation();
  const counts = (name: "days" | "uses", all: readonly number[]) => (
    <NativeSelect
      label={t(`people.new.${name}`)}
      value={String(wanted[name])}
      data={all.map((count) => ({ value: String(count), label: t(`people.new.${name}Of`, { count }) }))}
      onChange={(event) => set({ [name]: Number(event.currentTarget.value) })}
    />
  );
  return (
    <>
      <Radio.Group label={t("people.new.role")} value={wanted.role} onChange={(role) => set({ role })}>
        <div className={styles.roles}>
          {ROLES.map((role) => (
            <Radio
              key={role}
              value={role}
              label={t(`role.${role}`)}
              description={t(`people.new.about.${role}`)}
              data-autofocus={role === wanted.role || undefined}
            />
          ))}
        </div>
      </Radio.Group>
      <div className={styles.two}>
        {counts("days", DAYS)}
        {counts("uses", USES)}
      </div>
      {canMail ? (
        <TextInput
          type="email"
          label={t("people.new.email")}
          description={t("people.new.emailHint")}
          maxLength={254}
          value={wanted.email}
          onChange={(event) => set({ email: event.currentTarget.value })}
        />
      ) : (
        <p className={styles.hint}>{t("people.new.noMail")}</p>
      )}
    </>
  );
}

export function NewInvitation({ slug, canMail, onMade, onClose }: Props) {
  const { t } = useTranslation();
  useReturnFocus();
  const [wanted, setWanted] = useState(FRESH);
  const invite = useInvite(slug, useTellUnseen());
  return (
    <Modal opened onClose={onClose} title={t("people.new.title")} size={480}>
      <form
        className={pages.form}
        onSubmit={(event) => {
          event.preventDefault();
          // The link is shown also to who has closed the form before it came: it is shown this one time.
          invite
            .mutateAsync({ ...wanted, email: wanted.email.trim() }, { onSuccess: onClose })
            .then(onMade, () => undefined);
        }}
      >
        <Fields wanted={wanted} set={(some) => setWanted({ ...wanted, ...some })} canMail={canMail} />
        {invite.error ? <p role="alert">{problemText(invite.error, t("shell.problem.screen"))}</p> : null}
        <div className={pages.buttons}>
          <Button variant="default" onClick={onClose}>
            {t("people.cancel")}
          </Button>
          <Button type="submit" loading={invite.isPending}>
            {t(wanted.email.trim() ? "people.new.send" : "people.new.make")}
          </Button>
        </div>
      </form>
    </Modal>
  );
}

export function LinkShown({ made, onClose }: { made: MadeInvitation; onClose: () => void }) {
  const { t } = useTranslation();
  const role = t(`role.${made.role}`);
  return (
    <Modal
      opened
      onClose={onClose}
      closeOnClickOutside={false}
      closeOnEscape={false}
      title={t("people.shown.title", { role })}
      size={560}
    >
      <div className={pages.form}>
        {made.mailed === null ? null : (
          <p role="status">
            {t(made.mailed ? "people.shown.mailed" : "people.shown.notMailed", { email: made.email })}
          </p>
        )}
        <p>{t("people.shown.once")}</p>
        <SecretField
          label={t("people.shown.field")}
          value={made.link}
          copy={t("people.shown.copy")}
          copied={t("people.shown.copied")}
        />
        <Button onClick={onClose}>{t("people.shown.close")}</Button>
      </div>
    </Modal>
  );
}
