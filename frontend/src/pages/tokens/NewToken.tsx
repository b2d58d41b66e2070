/** The form for a new token, and the token itself, shown this one time. */
import { Button, Checkbox, Modal, NativeSelect, TextInput } from "@mantine/core";
import { useState } from "react";
import { useTranslation } from "react-i18next";
import { SecretField } from "@/design/SecretField";
import type { MadeToken, Site, TokenScope } from "@/api/types";
import { useReturnFocus } from "@/design/useReturnFocus";
import { problemText } from "@/shell/LoadProblem";
import { useTellUnseen } from "@/shell/refusal";
import pages from "../pages.module.css";
import styles from "./tokens.module.css";
import { isFixed, scopesOf, useMakeToken } from "./tokens";

const DAYS = [7, 30, 90, 365];

interface Props {
  site: Site;
  onMade: (token: MadeToken) => void;
  onClose: () => void;
}

export function NewToken({ site, onMade, onClose }: Props) {
  const { t } = useTranslation();
  useReturnFocus();
  const [name, setName] = useState("");
  const [days, setDays] = useState(90);
  const [scopes, setScopes] = useState<TokenScope[]>(["read"]);
  const make = useMakeToken(site.slug, useTellUnseen());
  const chosen = scopesOf(site.role).filter((scope) => scope === "read" || scopes.includes(scope));
  /** The token is shown also to who has closed the form before it came: it is shown this one time. */
  const send = () =>
    make.mutateAsync({ name: name.trim(), scopes: chosen, days }, { onSuccess: onClose }).then(onMade, () => undefined);
  return (
    <Modal opened onClose={onClose} title={t("tokens.new")} size={480}>
      <form
        className={pages.form}
        onSubmit={(event) => {
          event.preventDefault();
          void send();
        }}
      >
        <TextInput
          label={t("tokens.name")}
          placeholder={t("tokens.namePlaceholder")}
          maxLength={100}
          required
          data-autofocus
          value={name}
          onChange={(event) => setName(event.currentTarget.value)}
        />
        <Checkbox.Group label={t("tokens.scopesLabel")} value={chosen} onChange={(values) => setScopes(values)}>
          <div className={styles.scopes}>
            {scopesOf(site.role).map((scope) => (
              <Checkbox
                key={scope}
                value={scope}
                disabled={isFixed(scope, chosen)}
                label={t(`tokens.scope.${scope}`)}
                description={t(`tokens.about.${scope}`)}
              />
            ))}
          </div>
        </Checkbox.Group>
        <NativeSelect
          label={t("tokens.days")}
          value={String(days)}
          data={DAYS.map((count) => ({ value: String(count), label: t("tokens.daysOf", { count }) }))}
          onChange={(event) => setDays(Number(event.currentTarget.value))}
        />
        {make.error ? <p role="alert">{problemText(make.error, t("shell.problem.screen"))}</p> : null}
        <div className={pages.buttons}>
          <Button variant="default" onClick={onClose}>
            {t("tokens.cancel")}
          </Button>
          <Button type="submit" loading={make.isPending} disabled={!name.trim()}>
            {t("tokens.make")}
          </Button>
        </div>
      </form>
    </Modal>
  );
}

/** How a dashboard comes in to the broker; its password is the token. */
function BrokerWay({ way }: { way: NonNullable<MadeToken["broker"]> }) {
  const { t } = useTranslation();
  const fields = [
    ["address", way.address || t("tokens.broker.unknown")],
    ["username", way.username],
    ["topics", way.topics],
  ] as const;
  return (
    <>
      <p>{t("tokens.broker.text")}</p>
      {fields.map(([name, value]) => (
        <TextInput
          key={name}
          classNames={{ input: styles.mono }}
          label={t(`tokens.broker.${name}`)}
          readOnly
          value={value}
          onFocus={(event) => event.currentTarget.select()}
        />
      ))}
    </>
  );
}

export function TokenShown({ token, onClose }: { token: MadeToken; onClose: () => void }) {
  const { t } = useTranslation();
  return (
    <Modal
      opened
      onClose={onClose}
      closeOnClickOutside={false}
      closeOnEscape={false}
      title={t("tokens.shownTitle", { name: token.name })}
      size={560}
    >
      <div className={pages.form}>
        <p>{t("tokens.shownOnce")}</p>
        <SecretField
          label={t("tokens.field")}
          value={token.token}
          copy={t("tokens.copy")}
          copied={t("tokens.copied")}
        />
        {token.broker ? <BrokerWay way={token.broker} /> : null}
        <Button onClick={onClose}>{t("tokens.close")}</Button>
      </div>
    </Modal>
  );
}
